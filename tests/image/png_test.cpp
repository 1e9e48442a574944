// Tests PNG pictures, which libpng reads back.

#include "io/image/encode/png.hpp"

#include "folder.hpp"
#include "io/image/decode/decode_image.hpp"
#include "io/image/encode/eight_bits.hpp"

#include <microtrace/error.hpp>
#include <microtrace/io.hpp>

#include <cstdint>
#include <cstdlib>
#include <vector>

#include <gmock/gmock.h>

namespace microtrace {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::uint8_t> samples_of(const Film& film) {
  const std::size_t row = std::size_t{film.size().width} * (film.has_alpha() ? 4 : 3);
  std::vector<std::uint8_t> samples(row * film.size().height);
  for (std::uint32_t y = 0; y < film.size().height; ++y) {
    io::encode_row(film, y, &samples[y * row]);
  }
  return samples;
}

void expect_samples(const Film& film, const fs::path& path) {
  save_image(film, path);
  const io::DecodedImage read = io::decode_image(read_bytes(path));
  ASSERT_TRUE(read.image) << read.complaint;
  EXPECT_EQ(read.image->width, film.size().width);
  EXPECT_EQ(read.image->height, film.size().height);
  EXPECT_EQ(read.image->channels, film.has_alpha() ? 4U : 3U);
  EXPECT_EQ(std::get<std::vector<std::uint8_t>>(read.image->samples), samples_of(film));
}

std::vector<std::string> chunks_of(const std::string& png) {
  std::vector<std::string> names;
  for (std::size_t at = 8; at + 8 <= png.size();) {
    std::size_t length = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      length = length << 8U | static_cast<unsigned char>(png[at + i]);
    }
    names.push_back(png.substr(at + 4, 4));
    at += length + 12;
  }
  return names;
}

TEST(Png, StoresTheSamplesOfTheFilm) {
  const Folder folder;
  expect_samples(gradient(), folder / "a.png");
  expect_samples(gradient({1, 1}), folder / "b.PNG");
  expect_samples(gradient({3, 500}), folder / "c.png");
  expect_samples(gradient({700, 400}), folder / "large.png");  // large enough for several blocks
  Film numbers = gradient();
  numbers.display = {.srgb = false, .scale = Vec3(0.5F), .offset = Vec3(0.25F)};
  expect_samples(numbers, folder / "d.png");
  Film film({19, 7}, Film::Alpha::premultiplied);
  for (std::uint32_t x = 0; x < 19; ++x) {
    film.alpha_at(x, x % 7) = static_cast<float>(x) / 18;
    film.at(x, x % 7) = Vec3(0.5F) * film.alpha_at(x, x % 7);
  }
  expect_samples(film, folder / "e.png");
}

template <class Sample>
void expect_gray(ImageSize size) {
  std::vector<Sample> samples(std::size_t{size.width} * size.height);
  for (std::size_t i = 0; i < samples.size(); ++i)
    samples[i] = static_cast<Sample>(i * 2654435761U >> 7);
  const std::string png = io::encode_gray_png(size, samples);
  EXPECT_THAT(chunks_of(png), testing::Contains("IHDR"));
  EXPECT_EQ(png, io::encode_gray_png(size, samples));
  const io::DecodedImage read = io::decode_image(png);
  ASSERT_TRUE(read.image) << read.complaint;
  EXPECT_EQ(read.image->width, size.width);
  EXPECT_EQ(read.image->height, size.height);
  EXPECT_EQ(read.image->channels, 1U);
  EXPECT_EQ(std::get<std::vector<Sample>>(read.image->samples), samples);
}

TEST(Png, GrayPicturesOfEightAndSixteenBits) {
  for (const ImageSize size : {ImageSize{1, 1}, ImageSize{37, 11}, ImageSize{500, 300}}) {
    expect_gray<std::uint8_t>(size);
    expect_gray<std::uint16_t>(size);
  }
}

TEST(Png, HasAnSrgbChunkAndNoOthers) {
  const Folder folder;
  save_image(gradient(), folder / "a.png");
  EXPECT_THAT(chunks_of(read_bytes(folder / "a.png")),
              ElementsAre("IHDR", "gAMA", "sRGB", "cHRM", "IDAT", "IEND"));
  Film numbers = gradient();
  numbers.display = {.srgb = false};
  save_image(numbers, folder / "b.png");
  EXPECT_THAT(chunks_of(read_bytes(folder / "b.png")), ElementsAre("IHDR", "IDAT", "IEND"));
}

TEST(Png, StoresOnlyColorsAndAlpha) {
  const Folder folder;
  EXPECT_NO_THROW(check_image_path(folder / "a.png", {.alpha = true}));
  EXPECT_THROW(check_image_path(folder / "a.png", {.channels = true}), Error);
}

TEST(Png, FailedWritesLeaveNothing) {
  const Folder folder;
  fs::create_symlink("/dev/full", folder / "full.png");
  for (const char* name : {"missing/a.png", "full.png"}) {
    try {
      save_image(gradient({400, 300}), folder / name);
      ADD_FAILURE() << name;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::io) << name;
    }
  }
  EXPECT_EQ(folder.entries(), 1U);
}

TEST(Png, NamesThePackagesOfAMissingModule) {
  const Folder folder;
  ::setenv("MICROTRACE_MODULE_PATH", (folder / "nowhere").c_str(), 1);
  for (const bool broken : {false, true}) {
    if (broken) {
      fs::create_directory(folder / "nowhere");
      write_bytes(folder / "nowhere/microtrace_codecs.so", "not a library");
    }
    try {
      check_image_path(folder / "a.png");
      ADD_FAILURE();
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::unsupported);
      EXPECT_THAT(error.what(), testing::AllOf(HasSubstr("libpng-dev"), HasSubstr("nowhere"),
                                               HasSubstr("microtrace_codecs")));
    }
  }
  ::unsetenv("MICROTRACE_MODULE_PATH");
  EXPECT_NO_THROW(check_image_path(folder / "a.png"));
}

}  // namespace
}  // namespace microtrace
