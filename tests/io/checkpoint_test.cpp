#include <microtrace/checkpoint.hpp>
#include <microtrace/digest.hpp>
#include <microtrace/error.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

Checkpoint example() {
  Checkpoint checkpoint{
      .identity = "--seed\t1\nscene files\t7\n", .has_alpha = true, .has_lens = true, .samples = 9};
  checkpoint.sums = SampleSums({.width = 5, .height = 4}, {1, 1, 4, 3}, Vec3(0.25F, 0, 7));
  checkpoint.display = {.exposure = -1.5, .tone_map = ToneMap::agx};
  float x = -3;
  for (PixelSum& pixel : checkpoint.sums.pixels) {
    for (int i = 0; i < 4; ++i) {
      x += 0.7F;
      (void)pixel.add(Vec3(x, x * 1e10F, -x), 0.6F, Vec3(1));
    }
  }
  checkpoint.sums.note({.first = 2, .last = 4});
  checkpoint.sums.note({.first = 6, .last = 8});
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  checkpoint.channels = {
      {.name = "depth.Z", .values = std::vector<float>{1, -0.0F, kInfinity, 2, 3, 1e-40F}},
      {.name = "samples.N", .values = std::vector<float>(6, 7)},
      {.name = "id.instance", .values = std::vector<std::uint32_t>{0, 1, 0xffffffff, 3, 4, 5}}};
  checkpoint.only_for_denoising = {"id.instance"};
  return checkpoint;
}

class CheckpointFile : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(path_); }
  std::filesystem::path path_ =
      std::filesystem::path(testing::TempDir()) /
      ("checkpoint_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
};

TEST_F(CheckpointFile, StoresAllMembers) {
  const Checkpoint written = example();
  save_checkpoint(written, path_);
  const Checkpoint read = load_checkpoint(path_);
  EXPECT_EQ(read.identity, written.identity);
  EXPECT_TRUE(read.has_alpha);
  EXPECT_TRUE(read.has_lens);
  EXPECT_FALSE(read.has_ground);
  EXPECT_EQ(read.samples, 9U);
  EXPECT_EQ(read.display.exposure, -1.5);
  EXPECT_EQ(read.display.tone_map, ToneMap::agx);
  EXPECT_EQ(read.sums.whole.width, 5U);
  EXPECT_EQ(read.sums.whole.height, 4U);
  EXPECT_EQ(read.sums.window, written.sums.window);
  EXPECT_EQ(read.sums.background, written.sums.background);
  EXPECT_EQ(read.sums.ranges(), written.sums.ranges());
  EXPECT_EQ(read.sums.pixels, written.sums.pixels);
  ASSERT_EQ(read.channels.size(), 3U);
  for (const std::size_t i : {0U, 2U}) {
    EXPECT_EQ(read.channels[i].name, written.channels[i].name);
    EXPECT_EQ(read.channels[i].values, written.channels[i].values);
  }
  EXPECT_EQ(read.only_for_denoising, written.only_for_denoising);
  const Film film = picture_of(read);
  EXPECT_EQ(film.channels[0].values, written.channels[0].values);
  EXPECT_EQ(film.channels[1].name, "samples.N");
  EXPECT_EQ(std::get<std::vector<float>>(film.channels[1].values), std::vector<float>(6, 4));
}

TEST(Checkpoint, RefusesOtherValuesOfChannels) {
  Checkpoint sum = example(), other = example();
  other.sums = SampleSums(sum.sums.whole, sum.sums.window, sum.sums.background);
  std::get<std::vector<float>>(other.channels[1].values)[0] = 1;  // computed from the samples
  EXPECT_NO_THROW(add_samples(sum, other, "c"));
  std::get<std::vector<float>>(other.channels[0].values)[1] = 0;
  EXPECT_THROW(add_samples(sum, other, "c"), Error);
}

TEST(Checkpoint, ShowsTheChannelsOfAllCheckpoints) {
  const std::vector<std::string> both{"depth.Z", "id.instance"}, one{"depth.Z"};
  const auto joined = [](const std::vector<std::string>& a, const std::vector<std::string>& b) {
    Checkpoint sum = example(), other = example();
    other.sums = SampleSums(sum.sums.whole, sum.sums.window, sum.sums.background);
    sum.only_for_denoising = a;
    other.only_for_denoising = b;
    add_samples(sum, std::move(other), "c");
    return sum.only_for_denoising;
  };
  EXPECT_EQ(joined(both, both), both);
  EXPECT_EQ(joined(both, one), one);
  EXPECT_EQ(joined(one, both), one);
  EXPECT_TRUE(joined(both, {}).empty());
}

TEST_F(CheckpointFile, DetectsEveryChangedBit) {
  save_checkpoint(example(), path_);
  std::string bytes(std::filesystem::file_size(path_), '\0');
  std::ifstream(path_, std::ios::binary)
      .read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::string other = bytes;
    other[i] = static_cast<char>(other[i] ^ (1 << i % 8));
    std::ofstream(path_, std::ios::binary) << other;
    EXPECT_THROW((void)load_checkpoint(path_), Error) << i;
    std::ofstream(path_, std::ios::binary) << bytes.substr(0, i);
    EXPECT_THROW((void)load_checkpoint(path_), Error) << i;
  }
}

/// The file's content with a digest that fits it.
std::string with_digest(std::string bytes) {
  Digest digest;
  digest.add(std::string_view(bytes).substr(0, bytes.size() - 8));
  for (unsigned i = 0; i < 8; ++i)
    bytes[bytes.size() - 8 + i] = static_cast<char>(digest.value() >> (8 * i) & 0xFFU);
  return bytes;
}

TEST_F(CheckpointFile, StoresSeveralCompressedBlocks) {
  Checkpoint written = example();
  written.sums = SampleSums({.width = 200, .height = 90}, {0, 0, 200, 90}, Vec3(0));
  std::uint32_t state = 1;
  for (std::size_t i = 0; i < written.sums.pixels.size(); ++i) {
    state = state * 1664525U + 1013904223U;
    const float noise = static_cast<float>(state >> 8U) * 0x1p-24F;
    (void)written.sums.pixels[i].add(Vec3(noise, 1, i < 9000 ? noise : 0), 1, Vec3(0));
  }
  written.sums.note({.first = 0, .last = 1});
  std::vector<float> depths(written.sums.pixels.size());
  for (std::size_t i = 0; i < depths.size(); ++i) depths[i] = static_cast<float>(i % 777);
  written.channels = {{.name = "depth.Z", .values = depths}};
  save_checkpoint(written, path_);
  EXPECT_LT(std::filesystem::file_size(path_), written.sums.pixels.size() * 84 / 3);
  const Checkpoint read = load_checkpoint(path_);
  EXPECT_EQ(read.sums.pixels, written.sums.pixels);
  ASSERT_EQ(read.channels.size(), 1U);
  EXPECT_EQ(std::get<std::vector<float>>(read.channels[0].values), depths);
}

TEST_F(CheckpointFile, DamageBeforeTheDigestIsRefusedOrReadInBoundedMemory) {
  save_checkpoint(example(), path_);
  std::string bytes(std::filesystem::file_size(path_), '\0');
  std::ifstream(path_, std::ios::binary)
      .read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  const auto load = [&](const std::string& content) {
    std::ofstream(path_, std::ios::binary) << with_digest(content);
    try {
      (void)load_checkpoint(path_);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::io);
      return false;
    }
    return true;
  };
  EXPECT_TRUE(load(bytes));
  for (std::size_t i = 0; i < bytes.size() - 8; ++i) {
    std::string other = bytes;
    other[i] = static_cast<char>(other[i] ^ (1 << i % 8));
    (void)load(other);
    EXPECT_FALSE(load(bytes.substr(0, i) + std::string(8, '\0'))) << i;
  }
  EXPECT_FALSE(load(bytes + '\0'));
  // The last coordinates of the window and the size of the picture claim 2^62 pixels.
  const std::size_t size = bytes.find("files\t7\n") + 8 + 4 + 4 + 8 + 4;
  std::string huge = bytes;
  for (const std::size_t number : {0U, 1U, 4U, 5U})
    huge.replace(size + 4 * number, 4, "\0\0\0\x7f", 4);
  EXPECT_FALSE(load(huge));
}

TEST(Checkpoint, NamesTheDifference) {
  const auto message = [](const std::string& there, const std::string& here,
                          const char* file = "") {
    Checkpoint ours{.identity = here, .file = file};
    try {
      add_samples(ours, Checkpoint{.identity = there}, "c");
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::usage);
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string start = "c: holds samples of another picture: made ";
  EXPECT_EQ(message("--seed\t1\n", "--seed\t2\n"), start + "with --seed 1, not with --seed 2");
  EXPECT_EQ(message("--seed\t1\n", ""), start + "with --seed 1, not without --seed");
  EXPECT_EQ(message("", "--a\tb c\n"), start + "without --a, not with --a b c");
  EXPECT_EQ(message("--a\tb\n", "--a\tb\n"), "");
  EXPECT_EQ(message("--b\t\n--seed\t1\n", "--a\t3\n--seed\t2\n"),
            start +
                "with --b, not without --b; with --seed 1, not with --seed 2; without --a, not " +
                "with --a 3");
  EXPECT_EQ(message("", "--a\t3\n", "folder/d"),
            "c: holds samples of another picture than folder/d: made without --a, not with --a 3");
}

TEST(Checkpoint, RefusesSamplesThatArePresent) {
  Checkpoint sum = example();
  Checkpoint other = example();
  other.sums.note({.first = 10, .last = 11});
  EXPECT_THROW(add_samples(sum, std::move(other), "c"), Error);
}

TEST(Checkpoint, DisplayIsThatOfTheFirstSamplesInAnyOrder) {
  const auto part = [](std::uint32_t first, double exposure) {
    Checkpoint result{.identity = "a", .display = {.exposure = exposure}};
    result.sums = SampleSums({.width = 1, .height = 1}, {0, 0, 1, 1}, Vec3(0));
    if (first != 0) result.sums.note({.first = first, .last = first + 1});
    return result;
  };
  for (const std::vector<Checkpoint>& parts :
       {std::vector{part(1, 3), part(2, 1), part(3, 2)}, std::vector{part(9, 3), part(0, 2)},
        std::vector{part(0, 1), part(0, 2)}}) {
    for (std::size_t turn = 0; turn < parts.size(); ++turn) {
      std::vector<Checkpoint> turned = parts;
      std::ranges::rotate(turned, turned.begin() + static_cast<std::ptrdiff_t>(turn));
      Checkpoint all{.identity = "a"};
      for (const Checkpoint& next : turned) add_samples(all, next, "c");
      EXPECT_EQ(all.display.exposure, parts.front().display.exposure) << turn;
    }
  }
}

TEST_F(CheckpointFile, RangesOfSamplesAreInOrderAndApart) {
  const SampleRange overlapping{.first = 3, .last = 5}, backwards{.first = 12, .last = 11},
      beyond_the_last{.first = 65535, .last = 65537};
  for (const SampleRange& range : {overlapping, backwards, beyond_the_last}) {
    Checkpoint damaged = example();
    damaged.sums.note(range);
    save_checkpoint(damaged, path_);
    EXPECT_THROW((void)load_checkpoint(path_), Error) << range.first;
  }
}

TEST(Digest, DependsOnBytesButNotOnTheirDivision) {
  const std::string text = "A number that tells byte strings apart";
  const auto digest = [](std::initializer_list<std::string_view> parts) {
    Digest result;
    for (const std::string_view part : parts) result.add(part);
    return result.value();
  };
  const std::uint64_t whole = digest({text});
  for (std::size_t i = 0; i <= text.size(); ++i) {
    const std::string_view view = text;
    EXPECT_EQ(digest({view.substr(0, i), view.substr(i)}), whole) << i;
    std::string other = text;
    if (i < text.size()) other[i] = static_cast<char>(other[i] ^ 1);
    EXPECT_NE(digest({i < text.size() ? other : text + '\0'}), whole) << i;
  }
  EXPECT_NE(digest({std::string_view("\0", 1)}), digest({}));
  EXPECT_NE(digest({std::string_view("\0\0", 2)}), digest({std::string_view("\0", 1)}));
}

}  // namespace
}  // namespace microtrace
