#include <microtrace/checkpoint.hpp>
#include <microtrace/digest.hpp>
#include <microtrace/error.hpp>

#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

Checkpoint example() {
  Checkpoint checkpoint{.identity = "--seed\t1\nscene files\t7\n", .has_alpha = true, .samples = 9};
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
  EXPECT_EQ(read.samples, 9U);
  EXPECT_EQ(read.display.exposure, -1.5);
  EXPECT_EQ(read.display.tone_map, ToneMap::agx);
  EXPECT_EQ(read.sums.whole.width, 5U);
  EXPECT_EQ(read.sums.whole.height, 4U);
  EXPECT_EQ(read.sums.window, written.sums.window);
  EXPECT_EQ(read.sums.background, written.sums.background);
  EXPECT_EQ(read.sums.ranges(), written.sums.ranges());
  EXPECT_EQ(read.sums.pixels, written.sums.pixels);
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

TEST(Checkpoint, NamesTheDifference) {
  const auto message = [](const std::string& there, const std::string& here) {
    Checkpoint ours{.identity = here};
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
}

TEST(Checkpoint, RefusesSamplesThatArePresent) {
  Checkpoint sum = example();
  Checkpoint other = example();
  other.sums.note({.first = 10, .last = 11});
  EXPECT_THROW(add_samples(sum, std::move(other), "c"), Error);
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
