#include "folder.hpp"
#include "scene/math/srgb.hpp"

#include <microtrace/error.hpp>
#include <microtrace/io.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <initializer_list>
#include <limits>
#include <random>
#include <string>

#include <gmock/gmock.h>

namespace microtrace {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// Returns a picture twice as wide as high. Its colors are all different and exact in half floats.
Film panorama() {
  Film film({.width = 8, .height = 4});
  for (std::uint32_t y = 0; y < 4; ++y) {
    for (std::uint32_t x = 0; x < 8; ++x)
      film.at(x, y) = Vec3(static_cast<float>(x), static_cast<float>(y) / 8, 100);
  }
  return film;
}

/// Runs oiiotool and discards its output.
void convert(const std::string& arguments) {
  ASSERT_EQ(std::system(("oiiotool " + arguments + " >/dev/null 2>&1").c_str()), 0) << arguments;
}

void expect_equal(const RadianceMap& map, const Film& film, double relative) {
  ASSERT_EQ(map.width, film.size().width);
  ASSERT_EQ(map.height, film.size().height);
  for (std::uint32_t y = 0; y < map.height; ++y) {
    for (std::uint32_t x = 0; x < map.width; ++x) {
      const Vec3 is = map.pixels[y * map.width + x], was = film.row(y)[x];
      for (glm::length_t i = 0; i < 3; ++i)
        ASSERT_NEAR(is[i], was[i], relative * double{std::max({was.x, was.y, was.z})});
    }
  }
}

ErrorKind kind_of(const fs::path& path, const std::string& word) {
  try {
    static_cast<void>(load_radiance_map(path));
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr(word));
    EXPECT_THAT(error.what(), HasSubstr(path.string()));
    return error.kind();
  }
  ADD_FAILURE() << path;
  return ErrorKind::internal;
}

TEST(RadianceMapFile, ExrStoresTheNumbersUnchanged) {
  const Folder folder;
  save_image(panorama(), folder / "a.exr");
  const LoadedRadianceMap loaded = load_radiance_map(folder / "a.exr");
  EXPECT_TRUE(loaded.warnings.empty());
  expect_equal(*loaded.map, panorama(), 0);
  convert((folder / "a.exr").string() + " -d half --tile 16 16 -o " +
          (folder / "half.EXR").string());
  expect_equal(*load_radiance_map(folder / "half.EXR").map, panorama(), 0);
}

TEST(RadianceMapFile, PartsAreAtTheirPlaces) {
  const Folder folder;
  Film whole = panorama(), part({.width = 3, .height = 2});
  part.whole = whole.size();
  part.x0 = 4;
  part.y0 = 1;
  for (std::uint32_t y = 0; y < 4; ++y) {
    for (std::uint32_t x = 0; x < 8; ++x) {
      const bool is_there = x >= 4 && x < 7 && y >= 1 && y < 3;
      if (is_there)
        part.at(x - 4, y - 1) = whole.at(x, y);
      else
        whole.at(x, y) = Vec3(0);
    }
  }
  save_image(part, folder / "part.exr");
  const LoadedRadianceMap loaded = load_radiance_map(folder / "part.exr");
  EXPECT_TRUE(loaded.warnings.empty());
  expect_equal(*loaded.map, whole, 0);
  // Pixels beyond the whole picture are left out.
  save_image(panorama(), folder / "a.exr");
  convert((folder / "a.exr").string() + " --fullsize 4x2+2+1 -o " + (folder / "b.exr").string());
  const LoadedRadianceMap inner = load_radiance_map(folder / "b.exr");
  ASSERT_EQ(inner.map->width, 4U);
  ASSERT_EQ(inner.map->height, 2U);
  EXPECT_EQ(inner.map->pixels[0], panorama().at(2, 1));
  EXPECT_EQ(inner.map->pixels[7], panorama().at(5, 2));
}

TEST(RadianceMapFile, HdrIsAccurateToEightBits) {
  const Folder folder;
  save_image(panorama(), folder / "a.hdr");
  const LoadedRadianceMap loaded = load_radiance_map(folder / "a.hdr");
  EXPECT_TRUE(loaded.warnings.empty());
  expect_equal(*loaded.map, panorama(), 1.0 / 256);
}

TEST(RadianceMapFile, HdrHasTheNearestNumbers) {
  const Folder folder;
  Film film({.width = 64, .height = 32});
  std::mt19937 random(1);
  std::uniform_real_distribution<float> mantissa(0.5F, 1), part(0, 1);
  std::uniform_int_distribution<int> exponent(-20, 20);
  for (std::uint32_t y = 0; y < 32; ++y) {
    for (std::uint32_t x = 0; x < 64; ++x) {
      const float most = std::ldexp(x == 0 ? 0.9999F : mantissa(random), exponent(random));
      film.at(x, y) = Vec3(most * part(random), most, most * part(random));
    }
  }
  save_image(film, folder / "a.hdr");
  const LoadedRadianceMap loaded = load_radiance_map(folder / "a.hdr");
  for (std::uint32_t y = 0; y < 32; ++y) {
    for (std::uint32_t x = 0; x < 64; ++x) {
      const Vec3 is = loaded.map->pixels[y * 64 + x], was = film.row(y)[x];
      // Half of the last place of a number of 8 bits; twice as much where the largest is rounded up
      // to a power of two.
      const double unit = std::exp2(std::ceil(std::log2(is.y * 1.0001)) - 8);
      for (glm::length_t i = 0; i < 3; ++i) ASSERT_LE(std::abs(double{is[i]} - was[i]), unit / 2);
    }
  }
  film.at(0, 0) = Vec3(1.8e38F, 3.4e38F, 1);
  save_image(film, folder / "a.hdr");
  EXPECT_EQ(load_radiance_map(folder / "a.hdr").map->pixels[0],
            Vec3(kMaxRadiance, kMaxRadiance, 0));
}

TEST(RadianceMapFile, HdrOfAnyOrientationIsUpright) {
  const Folder folder;
  constexpr int kWidth = 4, kHeight = 2;
  for (const bool is_by_column : {false, true}) {
    for (const bool goes_left : {false, true}) {
      for (const bool goes_up : {false, true}) {
        const std::string x_axis = goes_left ? "-X 4" : "+X 4", y_axis = goes_up ? "+Y 2" : "-Y 2";
        const std::string axes = is_by_column ? x_axis + " " + y_axis : y_axis + " " + x_axis;
        std::string file = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" + axes + "\n";
        for (int i = 0; i < kWidth * kHeight; ++i) {
          const int column = is_by_column ? i / kHeight : i % kWidth;
          const int row = is_by_column ? i % kHeight : i / kWidth;
          const int x = goes_left ? kWidth - 1 - column : column;
          const int y = goes_up ? kHeight - 1 - row : row;
          for (const int byte : {x + 1, y + 1, 0, 136}) file += static_cast<char>(byte);
        }
        write_bytes(folder / "a.hdr", file);
        const LoadedRadianceMap loaded = load_radiance_map(folder / "a.hdr");
        ASSERT_EQ(loaded.map->width, 4U) << axes;
        ASSERT_EQ(loaded.map->height, 2U) << axes;
        for (int y = 0; y < kHeight; ++y) {
          for (int x = 0; x < kWidth; ++x) {
            const Vec3 is = loaded.map->pixels[static_cast<std::size_t>(y * kWidth + x)];
            EXPECT_EQ(is, Vec3(x + 1, y + 1, 0)) << axes << ": " << x << "," << y;
          }
        }
      }
    }
  }
}

TEST(RadianceMapFile, TakesThePartOfAnOpenExrFileThatHasColors) {
  const Folder folder;
  save_image(panorama(), folder / "a.exr");
  const std::string in = (folder / "a.exr").string(), out = (folder / "parts.exr").string();
  convert(in + " --ch B --chnames Z " + in + " --siappend -o " + out);
  const LoadedRadianceMap loaded = load_radiance_map(out);
  EXPECT_TRUE(loaded.warnings.empty());
  expect_equal(*loaded.map, panorama(), 0);
}

TEST(RadianceMapFile, RefusesCutOffTiff) {
  const Folder folder;
  save_image(panorama(), folder / "a.exr");
  for (const char* compression : {"none", "lzw", "zip"}) {
    // The pixels are at the end of the file.
    const fs::path file = folder / "a.tif";
    convert((folder / "a.exr").string() + " --resize 256x128 -d float --compression " +
            compression + " -o " + file.string());
    const std::string whole = read_bytes(file);
    ASSERT_EQ(load_radiance_map(file).map->width, 256U);
    write_bytes(folder / "cut.tif", whole.substr(0, whole.size() / 2));
    EXPECT_EQ(kind_of(folder / "cut.tif", "can't be decoded"), ErrorKind::io) << compression;
  }
}

/// Returns a TIFF file of 8 x 1 gray pixels. Each entry of the directory is a tag, and a number of
/// 16 bits.
std::string tiff_file(std::initializer_list<std::array<unsigned, 2>> entries,
                      const std::string& pixels) {
  const auto u16 = [](std::size_t x) {
    return std::string{static_cast<char>(x & 255), static_cast<char>(x >> 8)};
  };
  const auto u32 = [&](std::size_t x) { return u16(x & 0xFFFF) + u16(x >> 16); };
  std::string result = "II*" + std::string(1, '\0') + u32(8) + u16(entries.size());
  const std::size_t end = 8 + 2 + 12 * entries.size() + 4;
  constexpr unsigned kShort = 3, kStripOffsets = 273;
  for (const auto& [tag, value] : entries)
    result += u16(tag) + u16(kShort) + u32(1) + u32(tag == kStripOffsets ? end : value);
  return result + u32(0) + pixels;
}

// OpenImageIO 2.4 misreads these files without an error.
TEST(RadianceMapFile, RefusesTiffThatWouldBeMisread) {
  const Folder folder;
  const fs::path file = folder / "a.tif";
  write_bytes(file, tiff_file({{256, 8}, {257, 1}, {262, 1}, {273, 0}, {278, 1}, {279, 1}}, "Z"));
  EXPECT_EQ(kind_of(file, "1 bit per sample"), ErrorKind::io);
  const std::string words(16, '\x11');
  for (const unsigned photometric : {0U, 1U}) {
    write_bytes(file, tiff_file({{256, 8},
                                 {257, 1},
                                 {258, 16},
                                 {262, photometric},
                                 {273, 0},
                                 {277, 1},
                                 {278, 1},
                                 {279, 16}},
                                words));
    if (photometric == 0)
      EXPECT_EQ(kind_of(file, "white is 0"), ErrorKind::io);
    else
      EXPECT_EQ(load_radiance_map(file).map->width, 8U);
  }
}

TEST(RadianceMapFile, BytesAndWordsAreSrgb) {
  const Folder folder;
  const std::string samples("\x80\x01\xff\x02\x00\x7f", 6);
  write_bytes(folder / "a.ppm", "P6\n2 1\n255\n" + samples);
  const LoadedRadianceMap bytes = load_radiance_map(folder / "a.ppm");
  const auto linear = [](int code) { return static_cast<float>(linear_from_srgb(code / 255.0)); };
  EXPECT_EQ(bytes.map->pixels[0], Vec3(linear(0x80), linear(1), 1));
  EXPECT_EQ(bytes.map->pixels[1], Vec3(linear(2), 0, linear(0x7f)));
  convert((folder / "a.ppm").string() + " -d uint16 -o " + (folder / "a.png").string());
  const LoadedRadianceMap words = load_radiance_map(folder / "a.png");
  EXPECT_EQ(words.map->pixels[0], bytes.map->pixels[0]);  // 257 c / 65535 = c / 255
  EXPECT_EQ(words.map->pixels[1], bytes.map->pixels[1]);
}

TEST(RadianceMapFile, GrayIsExpandedAndAlphaIgnored) {
  const Folder folder;
  save_image(panorama(), folder / "a.exr");
  const std::string in = (folder / "a.exr").string();
  convert(in + " --ch B -o " + (folder / "gray.exr").string());
  EXPECT_EQ(load_radiance_map(folder / "gray.exr").map->pixels[3], Vec3(100));
  convert(in + " --ch Z=0.5,R,G,B,A=0.25 -o " + (folder / "more.exr").string());
  expect_equal(*load_radiance_map(folder / "more.exr").map, panorama(), 0);
}

TEST(RadianceMapFile, TakesTheColorsOfAnOpenExrLayer) {
  const Folder folder;
  save_image(panorama(), folder / "a.exr");
  const std::string in = (folder / "a.exr").string();
  convert(in + " --chnames beauty.R,beauty.G,beauty.B -o " + (folder / "layer.exr").string());
  expect_equal(*load_radiance_map(folder / "layer.exr").map, panorama(), 0);
  convert(in + " --ch R,G -o " + (folder / "two.exr").string());
  EXPECT_EQ(kind_of(folder / "two.exr", "neither channels R, G and B nor a single one"),
            ErrorKind::io);
  convert(in + " --ch R,G,B --chnames Y,RY,BY -o " + (folder / "chroma.exr").string());
  EXPECT_EQ(kind_of(folder / "chroma.exr", "luminance and chroma"), ErrorKind::io);
}

TEST(RadianceMapFile, SurvivesDamagedOpenExrFiles) {
  const Folder folder;
  save_image(panorama(), folder / "a.exr");
  const std::string whole = read_bytes(folder / "a.exr");
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::string damaged = whole;
    damaged[i] = static_cast<char>(damaged[i] ^ 0xFF);
    write_bytes(folder / "b.exr", damaged);
    try {
      static_cast<void>(load_radiance_map(folder / "b.exr"));
    } catch (const Error& error) {
      EXPECT_TRUE(error.kind() == ErrorKind::io || error.kind() == ErrorKind::limit)
          << error.what();
    }
  }
  // The data window has 2^31 by 3 pixels.
  const std::size_t window = whole.find("dataWindow") + 11 + 6 + 4;
  std::string wide = whole;
  wide.replace(window + 8, 4, "\xff\xff\xff\x7f");
  write_bytes(folder / "wide.exr", wide);
  EXPECT_THAT(kind_of(folder / "wide.exr", ""), testing::AnyOf(ErrorKind::io, ErrorKind::limit));
}

TEST(RadianceMapFile, InvalidRadianceIsClampedWithAWarning) {
  const Folder folder;
  Film film = panorama();
  film.at(0, 0) = Vec3(-1, 2, 3);
  film.at(1, 0) = Vec3(std::numeric_limits<float>::infinity(), 0, 0);
  film.at(2, 0) = Vec3(0, std::nanf(""), 5);
  film.at(3, 0) = Vec3(0, 0, 1e20F);
  save_image(film, folder / "a.exr");
  const LoadedRadianceMap loaded = load_radiance_map(folder / "a.exr");
  ASSERT_EQ(loaded.warnings.size(), 1U);
  EXPECT_THAT(loaded.warnings[0].text(), HasSubstr("4 pixels"));
  const std::vector<Vec3>& pixels = loaded.map->pixels;
  EXPECT_EQ(pixels[0], Vec3(0, 2, 3));
  EXPECT_EQ(pixels[1], Vec3(kMaxRadiance, 0, 0));
  EXPECT_EQ(pixels[2], Vec3(0, 0, 5));
  EXPECT_EQ(pixels[3], Vec3(0, 0, kMaxRadiance));
}

TEST(RadianceMapFile, OtherAspectRatiosGiveAWarning) {
  const Folder folder;
  save_image(Film({.width = 3, .height = 3}), folder / "a.exr");
  const LoadedRadianceMap loaded = load_radiance_map(folder / "a.exr");
  ASSERT_EQ(loaded.warnings.size(), 1U);
  EXPECT_THAT(loaded.warnings[0].text(), HasSubstr("twice as wide as high"));
}

TEST(RadianceMapFile, RefusesUnreadableFiles) {
  const Folder folder;
  save_image(panorama(), folder / "a.exr");
  EXPECT_EQ(kind_of(folder / "missing.exr", "missing.exr"), ErrorKind::io);
  write_bytes(folder / "cut.exr", read_bytes(folder / "a.exr").substr(0, 200));
  EXPECT_EQ(kind_of(folder / "cut.exr", "can't be decoded"), ErrorKind::io);
  write_bytes(folder / "text.hdr", "no picture");
  EXPECT_EQ(kind_of(folder / "text.hdr", "can't be decoded"), ErrorKind::io);
  write_bytes(folder / "empty.png", "");
  EXPECT_EQ(kind_of(folder / "empty.png", "can't be decoded"), ErrorKind::io);
  for (const char* name : {"a.null", "a"}) {
    write_bytes(folder / name, read_bytes(folder / "a.exr"));
    EXPECT_EQ(kind_of(folder / name, "can't be decoded"), ErrorKind::io) << name;
  }
}

TEST(RadianceMapFile, RefusesSizesBeforeAllocation) {
  const Folder folder;
  const std::string header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";
  write_bytes(folder / "large.hdr", header + "-Y 65536 +X 65536\n");
  EXPECT_EQ(kind_of(folder / "large.hdr", "65536 x 65536"), ErrorKind::limit);
  write_bytes(folder / "wide.hdr", header + "-Y 1 +X 70000\n");
  EXPECT_EQ(kind_of(folder / "wide.hdr", "70000 x 1"), ErrorKind::limit);
}

TEST(RadianceMapFile, NamesTheMissingModule) {
  const Folder folder;
  save_image(panorama(), folder / "a.exr");
  ::setenv("MICROTRACE_MODULE_PATH", (folder / "nowhere").c_str(), 1);
  EXPECT_EQ(kind_of(folder / "a.exr", "microtrace_openexr"), ErrorKind::unsupported);
  ::unsetenv("MICROTRACE_MODULE_PATH");
}

}  // namespace
}  // namespace microtrace
