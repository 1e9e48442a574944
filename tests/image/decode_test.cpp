#include "base/memory_account.hpp"
#include "io/gltf/bytes/uri.hpp"
#include "io/image/decode/decode_image.hpp"
#include "io/image/decode/image_header.hpp"
#include "support/png_file.hpp"

#include <cstdint>
#include <vector>

#include <gmock/gmock.h>

namespace microtrace::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using tests::PngColor;
using tests::PngPicture;

using Bytes = std::vector<std::uint8_t>;
using Shorts = std::vector<std::uint16_t>;

/// A picture of 4 x 3 pixels. The first two and a half rows have one color, the other pixels
/// another.
const std::string kJpeg = gltf::decode_base64(
                              "/9j/4AAQSkZJRgABAQAAAQABAAD/"
                              "2wBDAA0JCgsKCA0LCgsODg0PEyAVExISEyccHhcgLikxMC4pLSwzOko+MzZGNywt"
                              "QFdBRkxOUlNSMj5aYVpQYEpRUk//"
                              "2wBDAQ4ODhMREyYVFSZPNS01T09PT09PT09PT09PT09PT09PT09PT09PT09PT09P"
                              "T09PT09PT09PT09PT09PT09PT0//wAARCAADAAQDASIAAhEBAxEB/"
                              "8QAFQABAQAAAAAAAAAAAAAAAAAAAAX/xAAXEAEB"
                              "AQEAAAAAAAAAAAAAAAAAAQJC/8QAFAEBAAAAAAAAAAAAAAAAAAAABv/"
                              "EABsRAQACAgMAAAAAAAAAAAAAAAEAAwKRBBEh"
                              "/9oADAMBAAIRAxEAPwCXMZnMAKSms8MTUPvLvXtzds//2Q==")
                              .value();
const std::string kLosslessWebp = gltf::decode_base64(
                                      "UklGRkIAAABXRUJQVlA4TDUAAAAvAUAAEB8gpiHMp39ePcSkCfjZP/"
                                      "AUtG3D9I8/4EkCAcK6M2cC2MzevqCmbQMWv0lHRP+"
                                      "DAwA=")
                                      .value();
const std::string kLossyWebp = gltf::decode_base64(
                                   "UklGRlYAAABXRUJQVlA4IEoAAAAQAgCdASoEAAMAAsBMJbACdLoA1AD9QARgAP7"
                                   "o7xTadZxA8MR/4613qhDM+wZrHr5+"
                                   "gXdn/gf/Et+Mkc/M7e0f50ZbVH589cgAAA==")
                                   .value();

Image decode(const std::string& bytes) {
  const DecodedImage decoded = decode_image(bytes);
  EXPECT_TRUE(decoded.image) << decoded.complaint;
  EXPECT_THAT(decoded.complaint, IsEmpty());
  return decoded.image.value_or(Image{});
}

void expect_size(const Image& image, std::uint32_t width, std::uint32_t height,
                 std::uint32_t channels) {
  EXPECT_EQ(image.width, width);
  EXPECT_EQ(image.height, height);
  EXPECT_EQ(image.channels, channels);
}

TEST(DecodeImage, PngOfFourChannels) {
  const Image image = decode(tests::png_of(2, 1, {1, 2, 3, 4, 255, 0, 128, 0}));
  expect_size(image, 2, 1, 4);
  EXPECT_THAT(std::get<Bytes>(image.samples), ElementsAre(1, 2, 3, 4, 255, 0, 128, 0));
}

TEST(DecodeImage, PngOfSixteenBits) {
  const Image image = decode(tests::png_file({.width = 2,
                                              .depth = 16,
                                              .color = PngColor::gray_alpha,
                                              .rows = {"\x12\x34\xFF\xFF"
                                                       "\xAB\xCD\x01\x02"}}));
  expect_size(image, 2, 1, 2);
  EXPECT_THAT(std::get<Shorts>(image.samples), ElementsAre(0x1234, 0xFFFF, 0xABCD, 0x0102));
}

TEST(DecodeImage, PngWithPaletteAndTransparency) {
  // Four pixels of two bits each, with the palette indices 0, 1, 2, 1.
  PngPicture picture{.width = 4, .depth = 2, .color = PngColor::palette, .rows = {"\x19"}};
  picture.before_pixels = {{"PLTE", "abcdefghi"}};
  const Image rgb = decode(tests::png_file(picture));
  expect_size(rgb, 4, 1, 3);
  EXPECT_EQ(std::get<Bytes>(rgb.samples),
            (Bytes{'a', 'b', 'c', 'd', 'e', 'f', 'g', 'h', 'i', 'd', 'e', 'f'}));
  picture.before_pixels.push_back({"tRNS", "\x80"});
  const Image rgba = decode(tests::png_file(picture));
  expect_size(rgba, 4, 1, 4);
  EXPECT_EQ(std::get<Bytes>(rgba.samples)[3], 0x80);
  EXPECT_EQ(std::get<Bytes>(rgba.samples)[7], 0xFF);
}

TEST(DecodeImage, PngGammaAndProfilesChangeNothing) {
  PngPicture picture{.color = PngColor::gray, .rows = {"\x40"}};
  const Image plain = decode(tests::png_file(picture));
  picture.before_pixels = {{"gAMA", std::string("\0\1\x86\xA0", 4)},
                           {"iCCP", std::string("no profile\0\0really", 18)}};
  EXPECT_EQ(plain.samples, decode(tests::png_file(picture)).samples);
  expect_size(plain, 1, 1, 1);
}

TEST(DecodeImage, DamagedPngGivesTheReason) {
  const std::string file = tests::png_of(1, 1, {1, 2, 3, 4});
  std::string damaged = file;
  damaged[49] ^= 1;  // changes the pixel data
  EXPECT_FALSE(decode_image(damaged).image);
  EXPECT_THAT(decode_image(damaged).complaint, HasSubstr("IDAT"));
  for (std::size_t size = 0; size < file.size() - 12; ++size) {
    const DecodedImage decoded = decode_image(file.substr(0, size));
    EXPECT_FALSE(decoded.image) << size;
    EXPECT_FALSE(decoded.complaint.empty()) << size;
  }
}

TEST(DecodeImage, DecompressionBombIsRefusedBySize) {
  const DecodedImage decoded =
      decode_image(tests::png_file({.width = 1U << 15U, .height = (1U << 13U) + 1, .rows = {"x"}}));
  EXPECT_TRUE(decoded.too_large);
  EXPECT_FALSE(decoded.image);
}

TEST(DecodeImage, JpegGivesTheSameBytesEverywhere) {
  const Image image = decode(kJpeg);
  expect_size(image, 4, 3, 3);
  EXPECT_EQ(
      std::get<Bytes>(image.samples),
      (Bytes{150, 42, 78,  150, 42, 78, 142, 45,  86, 144, 47,  88, 161, 53,  89, 161, 53, 89, 153,
             56,  97, 154, 57,  98, 27, 109, 219, 27, 109, 219, 21, 112, 226, 22, 113, 227}));
}

TEST(DecodeImage, TruncatedJpegIsDecodedWithAWarning) {
  const DecodedImage decoded = decode_image(kJpeg.substr(0, kJpeg.size() - 8));
  EXPECT_TRUE(decoded.image);
  EXPECT_THAT(decoded.complaint, HasSubstr("end"));
  EXPECT_FALSE(decode_image(kJpeg.substr(0, 100)).image);
}

TEST(DecodeImage, HarmlessOdditiesOfJpegGiveNoWarning) {
  const DecodedImage usual = decode_image(kJpeg);
  std::string padded = kJpeg, other_version = kJpeg;
  padded.insert(kJpeg.size() - 2, 8, '\x11');  // before the end marker
  ASSERT_EQ(kJpeg.substr(6, 4), "JFIF");
  other_version[11] = 2;
  for (const std::string& file : {padded, other_version}) {
    const DecodedImage decoded = decode_image(file);
    EXPECT_EQ(decoded.complaint, "");
    ASSERT_TRUE(decoded.image);
    EXPECT_EQ(decoded.image->samples, usual.image->samples);
  }
}

TEST(DecodeImage, WebpLosslessAndLossy) {
  const Image exact = decode(kLosslessWebp);
  expect_size(exact, 2, 2, 4);
  EXPECT_THAT(std::get<Bytes>(exact.samples),
              ElementsAre(255, 0, 0, 255, 0, 255, 0, 128, 1, 2, 3, 255, 9, 8, 7, 64));
  const Image lossy = decode(kLossyWebp);
  expect_size(lossy, 4, 3, 3);
  EXPECT_EQ(std::get<Bytes>(lossy.samples)[0], 239);
  EXPECT_EQ(std::get<Bytes>(lossy.samples)[35], 210);
  EXPECT_FALSE(decode_image(kLosslessWebp.substr(0, 50)).image);
}

TEST(DecodeImage, TheSmallestWebpIsWhole) {
  const std::string tiny = gltf::decode_base64("UklGRhQAAABXRUJQVlA4TAgAAAAvA8AAEIiICA==").value();
  ASSERT_EQ(tiny.size(), 28U);
  const Image image = decode(tiny);
  expect_size(image, 4, 4, 4);
  EXPECT_THAT(std::get<Bytes>(image.samples), testing::Each(0));
}

// libwebp would decode the remaining bytes as a picture of arbitrary size that has no container.
TEST(DecodeImage, WebpWithoutPictureIsRefusedBeforeAllocation) {
  const auto made = [](std::string_view kind) {
    std::string file = kLosslessWebp;
    file.replace(12, 4, kind);
    return decode_image(file);
  };
  EXPECT_TRUE(made("VP8L").image);
  EXPECT_FALSE(made("/P8X").image);
  EXPECT_THAT(made("/P8X").complaint, HasSubstr("header is damaged"));
  EXPECT_THAT(decode_image(kLosslessWebp.substr(0, 14)).complaint, HasSubstr("header is damaged"));
  const std::string found = gltf::decode_base64("UklGRj4BAABXRUJQL1A4WAoAAAA6AAAAEQAACgAA").value();
  EXPECT_THAT(decode_image(found).complaint, HasSubstr("truncated or damaged"));
}

// libwebp accepts headers that are shorter than the shortest file, and sizes of 16384 x 7168 in
// them.
TEST(DecodeImage, TruncatedHeadersAreRefusedBeforeAllocation) {
  const std::string found = gltf::decode_base64("UklGRqwAAABXRUJQVlA4TJ8AAAAv////BlQ=").value();
  MemoryBudget budget(1 << 20);
  MemoryAccount account(&budget);
  const MemoryScope scope(account);
  EXPECT_THAT(decode_image(found).complaint, HasSubstr("truncated or damaged"));
}

TEST(DecodeImage, OtherFilesAreNotImages) {
  EXPECT_THAT(decode_image("GIF89a").complaint, HasSubstr("neither PNG, JPEG, WebP nor KTX2"));
  EXPECT_FALSE(decode_image("").image);
}

TEST(ImageHeader, HasTheSizeThatTheDecoderFinds) {
  using std::string_view_literals::operator""sv;
  const auto expect_header = [](const std::string& bytes, ImageFormat format, std::uint32_t width,
                                std::uint32_t height) {
    const ImageHeader header = read_image_header(bytes);
    EXPECT_EQ(header.format, format);
    EXPECT_EQ(header.state, ImageHeader::State::whole);
    EXPECT_EQ(header.width, width);
    EXPECT_EQ(header.height, height);
    for (std::size_t size = 0; size < 30; ++size) {
      const ImageHeader part = read_image_header(bytes.substr(0, size));
      EXPECT_EQ(part.width, 0U) << size;
      EXPECT_NE(part.state, ImageHeader::State::damaged) << size;
      if (part.format != ImageFormat::unknown) {
        EXPECT_EQ(part.state, ImageHeader::State::cut_off) << size;
      }
    }
  };
  expect_header(tests::png_file({.width = 70000, .height = 2}), ImageFormat::png, 70000, 2);
  expect_header(kJpeg, ImageFormat::jpeg, 4, 3);
  std::string loose = kJpeg;
  loose.insert(20, "\xFF\0stray\xFF"sv);  // stray bytes after the first segment
  EXPECT_TRUE(decode_image(loose).image);
  expect_header(loose, ImageFormat::jpeg, 4, 3);
  expect_header(kLosslessWebp, ImageFormat::webp, 2, 2);
  expect_header(kLossyWebp, ImageFormat::webp, 4, 3);
  EXPECT_EQ(read_image_header("BM").format, ImageFormat::unknown);
  for (const std::string_view nonsense :
       {"\xFF\xD8\xFF\xD9\0\0"sv, "\xFF\xD8\xFF\xDA\0\0"sv, "\xFF\xD8\xFF\0\0\0\0\0"sv,
        "\x89PNG\r\n\x1a\n\0\0\0\x0dIDAT"sv}) {
    EXPECT_EQ(read_image_header(nonsense).state, ImageHeader::State::damaged);
  }
  EXPECT_EQ(read_image_header(kJpeg.substr(0, 30)).state, ImageHeader::State::cut_off);
}

}  // namespace
}  // namespace microtrace::io
