#include "folder.hpp"

#include <microtrace/io.hpp>

#include <cmath>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

TEST(Ppm, BinaryHasTheDocumentedHeaderAndBytes) {
  Film film({2, 2});
  film.at(0, 0) = {1, 0, 0};
  film.at(1, 0) = {0, 1, 0};
  film.at(0, 1) = {0, 0, 1};
  film.at(1, 1) = {0.5F, 0.5F, 2};
  EXPECT_EQ(encode_ppm(film), std::string("P6\n2 2\n255\n"
                                          "\xff\0\0\0\xff\0"
                                          "\0\0\xff\xbc\xbc\xff",
                                          23));
}

TEST(Ppm, AsciiHasTheDocumentedTokens) {
  Film film({2, 1});
  film.at(0, 0) = {1, 0.5F, 0};
  EXPECT_EQ(encode_ppm(film, PpmEncoding::ascii), "P3\n2 1\n255\n255 188 0 0 0 0\n");
}

TEST(Ppm, AsciiHoldsTheSamePixelsAsBinary) {
  const Film film = gradient();
  std::istringstream ascii(encode_ppm(film, PpmEncoding::ascii));
  std::string magic;
  int width = 0, height = 0, maximum = 0;
  ascii >> magic >> width >> height >> maximum;
  std::string binary = "P6\n19 7\n255\n";
  for (int value = 0; ascii >> value;) binary += static_cast<char>(value);
  EXPECT_EQ(magic, "P3");
  EXPECT_EQ(width, 19);
  EXPECT_EQ(height, 7);
  EXPECT_EQ(maximum, 255);
  EXPECT_EQ(binary, encode_ppm(film));
}

TEST(Ppm, AsciiLinesHoldAtMost70Characters) {
  Film film({100, 3});
  for (std::uint32_t x = 0; x < 100; ++x) film.at(x, 1) = Vec3(1);
  std::istringstream lines(encode_ppm(film, PpmEncoding::ascii));
  for (std::string line; std::getline(lines, line);) {
    EXPECT_LE(line.size(), 70U);
    EXPECT_NE(line.back(), ' ');
  }
}

TEST(Ppm, SavedFileHoldsTheEncodedBytes) {
  const Folder folder;
  const Film film = gradient({300, 200});  // needs more than one write block
  for (const PpmEncoding encoding : {PpmEncoding::binary, PpmEncoding::ascii}) {
    save_image(film, folder / "a.PPM", encoding);
    EXPECT_EQ(read_bytes(folder / "a.PPM"), encode_ppm(film, encoding));
  }
}

TEST(Ppm, AlphaIsRefused) {
  const Film film({2, 1}, Film::Alpha::premultiplied);
  EXPECT_THROW((void)encode_ppm(film), Error);
  const Folder folder;
  EXPECT_THROW(save_image(film, folder / "a.ppm"), Error);
  EXPECT_THROW(check_image_path(folder / "a.ppm", {.alpha = true}), Error);
  EXPECT_THROW(check_image_path(folder / "a.ppm", {.channels = true}), Error);
  EXPECT_NO_THROW(check_image_path(folder / "a.ppm"));
  EXPECT_EQ(folder.entries(), 0U);
}

TEST(Ppm, QuantitiesAreShownByTheDisplaySettings) {
  Film film({5, 1});
  film.display = {.srgb = false, .scale = Vec3(0.5F), .offset = Vec3(0.5F, 0.5F, 0)};
  film.at(0, 0) = {-1, 0, 1};
  film.at(1, 0) = {1, 0.5F, 0.25F};
  film.at(2, 0) = {INFINITY, -INFINITY, NAN};
  film.at(3, 0) = {-3, 3, -0.1F};
  film.at(4, 0) = {0, 1.0F / 255, 2.0F / 255};  // codes 127.5, 128 and 1 before rounding
  EXPECT_EQ(encode_ppm(film, PpmEncoding::ascii),
            "P3\n5 1\n255\n0 128 128 255 191 32 255 0 0 0 255 0 128 128 1\n");
}

}  // namespace
}  // namespace microtrace
