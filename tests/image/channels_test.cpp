// Checks files with channels besides red, green and blue. OpenImageIO reads them back directly.

#include "folder.hpp"
#include "io/image/encode/eight_bits.hpp"

#include <microtrace/error.hpp>
#include <microtrace/io.hpp>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <span>
#include <string>
#include <vector>

#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>

namespace microtrace {
namespace {

namespace fs = std::filesystem;
using OIIO::ImageInput;
using OIIO::ImageSpec;
using OIIO::TypeDesc;
using testing::ElementsAre;
using testing::HasSubstr;

/// Opens a file without any conversion of alpha.
std::unique_ptr<ImageInput> open(const fs::path& path) {
  ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);
  std::unique_ptr<ImageInput> in = ImageInput::open(path.string(), &config);
  if (!in) throw std::runtime_error(OIIO::geterror());
  return in;
}

template <typename Number>
std::vector<Number> pixels(ImageInput& in, TypeDesc type) {
  const ImageSpec& spec = in.spec();
  std::vector<Number> result(spec.image_pixels() * static_cast<std::size_t>(spec.nchannels));
  EXPECT_TRUE(in.read_image(0, 0, 0, spec.nchannels, type, result.data()));
  return result;
}

/// Returns the gradient with an alpha channel. Alpha increases from 0 on the left to 1 on the
/// right.
Film see_through() {
  Film film({19, 7}, Film::Alpha::premultiplied);
  const Film colors = gradient();
  for (std::uint32_t y = 0; y < 7; ++y) {
    for (std::uint32_t x = 0; x < 19; ++x) {
      const float alpha = static_cast<float>(x) / 18;
      film.alpha_at(x, y) = alpha;
      film.at(x, y) = alpha * colors.row(y)[x];
    }
  }
  return film;
}

TEST(Alpha, IsUnassociatedInEightBits) {
  const Folder folder;
  const Film film = see_through();
  std::vector<std::uint8_t> expected(std::size_t{19} * 7 * 4);
  for (std::uint32_t y = 0; y < 7; ++y) io::encode_row(film, y, &expected[std::size_t{y} * 19 * 4]);
  for (const char* ending : {"png", "tif", "tga"}) {
    const fs::path path = folder / (std::string("a.") + ending);
    save_image(film, path);
    const auto in = open(path);
    ASSERT_EQ(in->spec().nchannels, 4) << ending;
    EXPECT_EQ(in->spec().alpha_channel, 3) << ending;
    EXPECT_EQ(pixels<std::uint8_t>(*in, TypeDesc::UINT8), expected) << ending;
  }
  // WebP is lossy and does not keep the exact colors.
  save_image(film, folder / "a.webp");
  const auto webp = open(folder / "a.webp");
  const auto read = pixels<std::uint8_t>(*webp, TypeDesc::UINT8);
  ASSERT_EQ(read.size(), expected.size());
  for (std::size_t i = 3; i < read.size(); i += 4) EXPECT_EQ(read[i], expected[i]);
}

TEST(Alpha, EightBitsComputedByHand) {
  Film film({4, 1}, Film::Alpha::premultiplied);
  film.at(0, 0) = {0.5F, 0.25F, 0};
  film.alpha_at(0, 0) = 0.5F;
  film.at(1, 0) = {0.3F, 0.3F, 0.3F};
  film.alpha_at(1, 0) = 1;
  film.at(2, 0) = {0, 0, 0};
  film.at(3, 0) = {9, 9, 9};  // 8-bit formats can't represent light without coverage
  std::vector<std::uint8_t> row(16);
  io::encode_row(film, 0, row.data());
  EXPECT_THAT(row, ElementsAre(255, 188, 0, 128, 149, 149, 149, 255, 0, 0, 0, 0, 0, 0, 0, 0));
}

TEST(Alpha, IsPremultipliedInFloat) {
  const Folder folder;
  const Film film = see_through();
  save_image(film, folder / "a.exr");
  const auto in = open(folder / "a.exr");
  EXPECT_THAT(in->spec().channelnames, ElementsAre("R", "G", "B", "A"));
  EXPECT_EQ(in->spec().alpha_channel, 3);
  EXPECT_EQ(in->spec().format, TypeDesc(TypeDesc::FLOAT));
  const auto read = pixels<float>(*in, TypeDesc::FLOAT);
  for (std::uint32_t y = 0; y < 7; ++y) {
    for (std::uint32_t x = 0; x < 19; ++x) {
      const float* pixel = &read[(std::size_t{y} * 19 + x) * 4];
      EXPECT_EQ(Vec3(pixel[0], pixel[1], pixel[2]), film.row(y)[x]);
      EXPECT_EQ(pixel[3], film.alpha_row(y)[x]);
    }
  }
}

TEST(Alpha, FormatsWithoutAlphaAreUsageErrors) {
  const Folder folder;
  for (const char* name : {"a.ppm", "a.jpg", "a.hdr", "a.gif"}) {
    for (const auto& attempt :
         {std::function<void()>([&] { save_image(see_through(), folder / name); }),
          std::function<void()>([&] { check_image_path(folder / name, {.alpha = true}); })}) {
      try {
        attempt();
        ADD_FAILURE() << name;
      } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::usage);
        EXPECT_THAT(error.what(), HasSubstr("has no alpha; write .png or .exr")) << name;
      }
    }
    EXPECT_NO_THROW(check_image_path(folder / name));
  }
  EXPECT_EQ(folder.entries(), 0U);
}

// Beyond these sizes, encoders fail after the rendering, write damaged files, or end the process.
TEST(Formats, RefuseSizesThatTheyCannotHold) {
  struct Case {
    const char* name;
    ImageSize size;
    bool fits;
  };
  const Folder folder;
  for (const Case& c : {Case{"a.jpg", {65500, 1}, true}, Case{"a.jpg", {65501, 1}, false},
                        Case{"a.webp", {1, 16383}, true}, Case{"a.webp", {1, 16384}, false},
                        Case{"a.tga", {65535, 1}, true}, Case{"a.tga", {65536, 1}, false},
                        Case{"a.gif", {65536, 1}, false}, Case{"a.png", {65536, 1}, true},
                        Case{"a.ppm", {65536, 1}, true}, Case{"a.jp2", {31, 320}, false},
                        Case{"a.jp2", {32, 32}, true}}) {
    const auto fails = [&](const auto& f) {
      try {
        f();
        return false;
      } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::usage) << error.what();
        return true;
      }
    };
    EXPECT_EQ(fails([&] { check_image_path(folder / c.name, {.size = c.size}); }), !c.fits)
        << c.name;
    EXPECT_EQ(fails([&] { save_image(Film(c.size), folder / c.name); }), !c.fits) << c.name;
    std::error_code missing;
    const auto bytes = std::filesystem::file_size(folder / c.name, missing);
    EXPECT_EQ(!missing && bytes > 0, c.fits) << c.name << ' ' << c.size.width;
    std::filesystem::remove(folder / c.name);
  }
  EXPECT_EQ(folder.entries(), 0U);
}

/// Returns a film with additional channels. Their numbers are exact only in float32 or only in
/// uint32.
Film with_channels(Film::Alpha alpha, ImageSize size = {19, 131}) {
  Film film(size, alpha);
  const std::size_t count = std::size_t{size.width} * size.height;
  std::vector<float> depth(count);
  std::vector<std::uint32_t> ids(count);
  for (std::size_t i = 0; i < count; ++i) {
    depth[i] = i % 7 == 0 ? INFINITY : 1.0F / static_cast<float>(i + 1);
    ids[i] = 0xFFFFFFFFU - static_cast<std::uint32_t>(i) * 3;
    const auto y = static_cast<std::uint32_t>(i / size.width);
    film.at(static_cast<std::uint32_t>(i % size.width), y) = Vec3(depth[i], 2, 0.1F);
  }
  film.channels.push_back({.name = "id.instance", .values = ids});
  film.channels.push_back({.name = "depth.Z", .values = depth});
  return film;
}

TEST(Channels, ExrKeepsAllBits) {
  const Folder folder;
  for (const Film::Alpha alpha : {Film::Alpha::none, Film::Alpha::premultiplied}) {
    const Film film = with_channels(alpha);
    save_image(film, folder / "a.exr");
    const auto in = open(folder / "a.exr");
    const ImageSpec& spec = in->spec();
    std::map<std::string, int> index;
    for (int c = 0; c < spec.nchannels; ++c)
      index[spec.channelnames[static_cast<std::size_t>(c)]] = c;
    ASSERT_EQ(spec.nchannels, film.has_alpha() ? 6 : 5);
    EXPECT_EQ(spec.channelformat(index.at("id.instance")), TypeDesc(TypeDesc::UINT32));
    EXPECT_EQ(spec.channelformat(index.at("depth.Z")), TypeDesc(TypeDesc::FLOAT));
    EXPECT_EQ(spec.channelformat(index.at("R")), TypeDesc(TypeDesc::FLOAT));
    EXPECT_EQ(index.contains("A"), film.has_alpha());
    std::vector<std::uint32_t> ids(spec.image_pixels());
    std::vector<float> depth(spec.image_pixels()), red(spec.image_pixels());
    const auto read = [&](const char* name, TypeDesc type, void* to) {
      const int c = index.at(name);
      ASSERT_TRUE(in->read_image(0, 0, c, c + 1, type, to)) << in->geterror();
    };
    read("id.instance", TypeDesc::UINT32, ids.data());
    read("depth.Z", TypeDesc::FLOAT, depth.data());
    read("R", TypeDesc::FLOAT, red.data());
    EXPECT_EQ(ids, std::get<std::vector<std::uint32_t>>(film.channels[0].values));
    EXPECT_EQ(depth, std::get<std::vector<float>>(film.channels[1].values));
    EXPECT_EQ(red, depth);
  }
}

TEST(Channels, OtherFormatsAreUsageErrors) {
  const Folder folder;
  for (const char* name : {"a.ppm", "a.png", "a.hdr", "a.tif"}) {
    try {
      save_image(with_channels(Film::Alpha::none), folder / name);
      ADD_FAILURE() << name;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::usage);
      EXPECT_THAT(error.what(), HasSubstr(".exr")) << name;
    }
    EXPECT_THROW(check_image_path(folder / name, {.channels = true}), Error);
  }
  EXPECT_NO_THROW(check_image_path(folder / "a.exr", {.alpha = true, .channels = true}));
  EXPECT_EQ(folder.entries(), 0U);
}

TEST(Crop, ExrKnowsTheWholePicture) {
  const Folder folder;
  Film film = gradient();
  film.whole = {.width = 100, .height = 50};
  film.x0 = 30;
  film.y0 = 40;
  save_image(film, folder / "a.exr");
  const auto in = open(folder / "a.exr");
  const ImageSpec& spec = in->spec();
  EXPECT_THAT((std::vector{spec.x, spec.y, spec.width, spec.height}), ElementsAre(30, 40, 19, 7));
  EXPECT_THAT((std::vector{spec.full_x, spec.full_y, spec.full_width, spec.full_height}),
              ElementsAre(0, 0, 100, 50));
  const auto read = pixels<float>(*in, TypeDesc::FLOAT);
  EXPECT_EQ(std::memcmp(read.data(), film.row(0).data(), read.size() * sizeof(float)), 0);
}

TEST(Display, QuantitiesHaveNoColorSpace) {
  const Folder folder;
  Film film = gradient();
  film.display = {.srgb = false};
  save_image(film, folder / "a.png");
  const auto in = open(folder / "a.png");
  const auto read = pixels<std::uint8_t>(*in, TypeDesc::UINT8);
  EXPECT_EQ(read[(19 + 9) * 3 + 1], std::lround(255.0 / 7));
}

}  // namespace
}  // namespace microtrace
