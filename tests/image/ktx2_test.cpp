#include "io/image/decode/decode_image.hpp"
#include "io/image/decode/image_header.hpp"
#include "io/image/decode/ktx2_colors.hpp"
#include "support/source_folder.hpp"

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <string>
#include <vector>

#include <gmock/gmock.h>

namespace microtrace::io {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

/// Reads a file that basisu 1.16.4 encoded from a picture of this project. uastc_modes_56x56 has
/// random bits for each of the 19 modes and each partition pattern.
std::string file(const std::string& name) {
  const auto path = tests::source_folder() / "tests/image/ktx2" / (name + ".ktx2");
  std::ifstream in(path, std::ios::binary);
  EXPECT_TRUE(in) << path;
  return {std::istreambuf_iterator<char>(in), {}};
}

struct Patch {
  std::size_t at;
  char byte;
};

DecodedImage decode_with(std::string bytes, std::initializer_list<Patch> patches) {
  for (const Patch& patch : patches) bytes.at(patch.at) = patch.byte;
  return decode_image(bytes);
}

std::size_t u32_at(const std::string& bytes, std::size_t at) {
  std::size_t result = 0;
  for (std::size_t i = 4; i-- > 0;) {
    result = result << 8U | static_cast<unsigned char>(bytes.at(at + i));
  }
  return result;
}

// Offsets in the header (KTX File Format Specification 2.0, section 2).
constexpr std::size_t kVkFormat = 12, kWidth = 20, kHeight = 24, kDepth = 28, kLayers = 32,
                      kFaces = 36, kScheme = 44, kDfdOffset = 48, kMetadataOffset = 56,
                      kGlobalOffset = 64, kLevelOffset = 80, kLevelLength = 88, kLevelSize = 96;
// Offsets in the data format descriptor.
constexpr std::size_t kModel = 12, kTransfer = 14, kFlags = 15, kChannel = 31;

/// FNV-1a hash.
std::uint64_t hash(const std::vector<std::uint8_t>& bytes) {
  std::uint64_t result = 0xCBF29CE484222325U;
  for (const std::uint8_t byte : bytes) result = (result ^ byte) * 0x100000001B3U;
  return result;
}

// The expected hashes are those of the RGBA32 samples of Basis Universal's transcoder.
TEST(DecodeKtx2, GivesTheSamplesOfTheReferenceTranscoder) {
  struct Case {
    const char* name;
    std::uint32_t width, height, channels;
    std::uint64_t hash;
  };
  for (const Case& c : {Case{"etc1s_3x5", 3, 5, 3, 0xF8A35F415160B3F5},
                        {"etc1s_alpha_mips_17x31", 17, 31, 4, 0x557BCB482FFBD3FC},
                        {"etc1s_checks_64x64", 64, 64, 4, 0x0D000368421290A5},
                        {"etc1s_gray_64x64", 64, 64, 3, 0xF7A3179ED1A2178F},
                        {"etc1s_runs_100x36", 100, 36, 4, 0x21ADE4235C074B9F},
                        {"etc1s_solid_64x64", 64, 64, 3, 0xA9D6EA0086C8A325},
                        {"uastc_linear_4x4", 4, 4, 3, 0x8E5A649C3F54F451},
                        {"uastc_modes_56x56", 56, 56, 4, 0xAD4DB9DCE015BAF0},
                        {"uastc_zstd_17x31", 17, 31, 4, 0x84C6FF46C8837319}}) {
    const DecodedImage decoded = decode_image(file(c.name));
    ASSERT_TRUE(decoded.image) << c.name << ": " << decoded.complaint;
    EXPECT_THAT(decoded.complaint, IsEmpty());
    EXPECT_EQ(decoded.image->width, c.width) << c.name;
    EXPECT_EQ(decoded.image->height, c.height) << c.name;
    EXPECT_EQ(decoded.image->channels, c.channels) << c.name;
    const auto& samples = std::get<std::vector<std::uint8_t>>(decoded.image->samples);
    EXPECT_EQ(hash(samples), c.hash) << c.name;
  }
}

const std::vector<std::uint8_t>& samples_of(const DecodedImage& decoded) {
  return std::get<std::vector<std::uint8_t>>(decoded.image.value().samples);
}

// Encoders for two channels store green as alpha. The same file, declared to have alpha, gives the
// expected numbers.
TEST(DecodeKtx2, RedAndGreen) {
  const std::string names[] = {"etc1s_checks_64x64", "uastc_modes_56x56"};
  constexpr char kRrr = 3, kGgg = 4, kRrrg = 5, kRg = 6;
  constexpr std::size_t kSampleSize = 16;
  for (const std::string& name : names) {
    const bool is_etc1s = name.starts_with("etc1s");
    const std::string whole = file(name);
    const std::size_t channel = u32_at(whole, kDfdOffset) + kChannel;
    const std::vector<std::uint8_t> rgba = samples_of(decode_image(whole));
    for (const bool is_packed : {true, false}) {
      if (is_etc1s && !is_packed) continue;
      const DecodedImage decoded =
          is_etc1s ? decode_with(whole, {{channel, kRrr}, {channel + kSampleSize, kGgg}})
                   : decode_with(whole, {{channel, is_packed ? kRrrg : kRg}});
      ASSERT_TRUE(decoded.image) << decoded.complaint;
      EXPECT_EQ(decoded.image->channels, 3U);
      const std::vector<std::uint8_t>& rg = samples_of(decoded);
      ASSERT_EQ(rg.size() / 3, rgba.size() / 4);
      for (std::size_t i = 0; i < rg.size() / 3; ++i) {
        ASSERT_EQ(rg[3 * i], rgba[4 * i]) << name << ' ' << i;
        ASSERT_EQ(rg[3 * i + 1], rgba[4 * i + (is_packed ? 3 : 1)]) << name << ' ' << i;
        ASSERT_EQ(rg[3 * i + 2], 0) << name << ' ' << i;
      }
    }
  }
}

// The picture is a gradient with red 7 x, green 5 y and blue 128 + x - y.
TEST(DecodeKtx2, StartsAtTheUpperLeft) {
  const Image image = decode_image(file("uastc_linear_4x4")).image.value();
  const auto& samples = std::get<std::vector<std::uint8_t>>(image.samples);
  for (std::size_t i = 0; i < 16; ++i) {
    EXPECT_NEAR(samples[3 * i], 7.0 * static_cast<double>(i % 4), 2) << i;
    EXPECT_NEAR(samples[3 * i + 1], 5.0 * static_cast<double>(i / 4), 2) << i;
  }
}

TEST(DecodeKtx2, TruncatedFilesGiveTheReason) {
  for (const char* name : {"etc1s_3x5", "uastc_linear_4x4", "uastc_zstd_17x31"}) {
    const std::string whole = file(name);
    for (std::size_t size = 12; size < whole.size(); ++size) {
      const DecodedImage decoded = decode_image(whole.substr(0, size));
      EXPECT_FALSE(decoded.image) << name << ' ' << size;
      EXPECT_FALSE(decoded.complaint.empty()) << name << ' ' << size;
    }
  }
}

TEST(DecodeKtx2, UnsupportedTexturesAreRefusedByName) {
  const std::string etc1s = file("etc1s_3x5"), uastc = file("uastc_linear_4x4");
  const std::size_t dfd = u32_at(uastc, kDfdOffset), etc1s_dfd = u32_at(etc1s, kDfdOffset);
  const auto expect = [](const std::string& bytes, Patch patch, const char* words) {
    const DecodedImage decoded = decode_with(bytes, {patch});
    EXPECT_FALSE(decoded.image) << words;
    EXPECT_THAT(decoded.complaint, HasSubstr(words));
  };
  expect(uastc, {kVkFormat, 37}, "Vulkan format 37");
  expect(uastc, {kHeight, 0}, "one dimension");
  expect(uastc, {kDepth, 4}, "three dimensions");
  expect(uastc, {kLayers, 1}, "layers");
  expect(uastc, {kFaces, 6}, "6 faces");
  expect(uastc, {kScheme, 3}, "zlib");
  expect(uastc, {kScheme, 9}, "supercompression scheme 9");
  expect(uastc, {dfd + kModel, static_cast<char>(167)}, "color model 167");
  expect(uastc, {dfd + kChannel, 1}, "channels");
  expect(etc1s, {etc1s_dfd + kChannel, 5}, "channels");
  expect(etc1s, {kScheme, 0}, "ETC1S without BasisLZ");
  expect(etc1s, {u32_at(etc1s, kGlobalOffset) + 20, 2}, "video");
}

TEST(DecodeKtx2, MetadataMayNotFlipOrSwizzle) {
  const std::string plain = file("uastc_linear_4x4");
  const auto decode_with_entry = [&](std::string entry) {
    const std::size_t size = entry.size();
    entry.resize((size + 3) / 4 * 4);
    std::string bytes = plain;
    const auto set = [&bytes](std::size_t at, std::size_t value) {
      for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<char>(value >> 8 * i & 255U);
    };
    set(kMetadataOffset, bytes.size());
    set(kMetadataOffset + 4, 4 + entry.size());
    bytes.append(4, '\0');
    set(bytes.size() - 4, size);
    return decode_image(bytes + entry);
  };
  using std::string_literals::operator""s;
  EXPECT_TRUE(decode_with_entry("KTXorientation\0rd\0"s).image);
  EXPECT_THAT(decode_with_entry("KTXorientation\0ru\0"s).complaint, HasSubstr("KTXorientation"));
  EXPECT_TRUE(decode_with_entry("KTXswizzle\0rgba\0"s).image);
  EXPECT_THAT(decode_with_entry("KTXswizzle\0rrrg\0"s).complaint, HasSubstr("KTXswizzle"));
  EXPECT_TRUE(decode_with_entry("KTXwriter\0someone\0"s).image);
  EXPECT_THAT(decode_with_entry("KTXwriter"s).complaint, HasSubstr("metadata is damaged"));
}

TEST(DecodeKtx2, SizesAreCheckedBeforeAllocation) {
  // The size is 2^24 x 2^24 texels, whose blocks exceed any file size.
  const DecodedImage etc1s = decode_with(
      file("etc1s_3x5"), {{kWidth, 0}, {kWidth + 3, 1}, {kHeight, 0}, {kHeight + 3, 1}});
  EXPECT_TRUE(etc1s.too_large);
  EXPECT_FALSE(etc1s.image);
  const DecodedImage uastc = decode_with(file("uastc_zstd_17x31"), {{kWidth + 3, 1}});
  EXPECT_FALSE(uastc.image);
  EXPECT_THAT(uastc.complaint, HasSubstr("size of its blocks"));
}

// Frames of a streaming encoder don't state their size, and skippable frames have no content.
TEST(DecodeKtx2, ZstandardMayHaveAnyFrames) {
  const std::string whole = file("uastc_zstd_17x31");
  const std::size_t frame = u32_at(whole, kLevelOffset);
  ASSERT_EQ(whole[frame + 4], 0x60);  // one segment, with a size of two bytes
  std::string streamed = whole;
  streamed.replace(frame + 4, 3, {0, 0});  // a window of 1 KiB instead
  streamed[kLevelLength] = static_cast<char>(whole[kLevelLength] - 1);
  std::string skipping = whole;
  skipping.insert(frame, std::string("\x50\x2A\x4D\x18\x01\0\0\0x", 9));
  skipping[kLevelLength] = static_cast<char>(whole[kLevelLength] + 9);
  for (const std::string& bytes : {streamed, skipping}) {
    const DecodedImage decoded = decode_image(bytes);
    ASSERT_TRUE(decoded.image) << decoded.complaint;
    EXPECT_EQ(samples_of(decoded), samples_of(decode_image(whole)));
  }
}

TEST(DecodeKtx2, DamagedDataGivesTheReason) {
  const std::string zstd = file("uastc_zstd_17x31"), plain = file("uastc_linear_4x4");
  const std::size_t frame = u32_at(zstd, kLevelOffset);
  EXPECT_THAT(decode_with(zstd, {{frame, 0}}).complaint, HasSubstr("data is damaged"));
  EXPECT_THAT(decode_with(zstd, {{frame + 7, '\xFF'}}).complaint, HasSubstr("data is damaged"));
  EXPECT_THAT(decode_with(zstd, {{kLevelSize, 0}}).complaint, HasSubstr("size of its blocks"));
  EXPECT_THAT(decode_with(plain, {{kLevelLength, 15}}).complaint, HasSubstr("size of its blocks"));
  EXPECT_THAT(decode_with(plain, {{plain.size() - 16, 0x45}}).complaint,
              HasSubstr("reserved mode"));
  // Mode 3 has only 11 patterns.
  EXPECT_THAT(decode_with(plain, {{plain.size() - 16, 3}, {plain.size() - 14, '\xF0'}}).complaint,
              HasSubstr("reserved pattern"));
}

// A damaged file must either decode to some image or fail with a reason.
TEST(DecodeKtx2, NoModifiedByteCrashesTheDecoder) {
  for (const char* name : {"etc1s_3x5", "etc1s_alpha_mips_17x31", "etc1s_runs_100x36"}) {
    const std::string whole = file(name);
    for (std::size_t at = kDepth; at < whole.size(); ++at) {
      for (const unsigned mask : {1U, 128U, 255U}) {
        const auto byte = static_cast<unsigned char>(whole[at]);
        const DecodedImage decoded = decode_with(whole, {{at, static_cast<char>(byte ^ mask)}});
        EXPECT_TRUE(decoded.image || decoded.too_large || !decoded.complaint.empty()) << at;
      }
    }
  }
}

TEST(ImageHeader, OfKtx2) {
  const std::string whole = file("etc1s_runs_100x36");
  const ImageHeader header = read_image_header(whole);
  EXPECT_EQ(header.format, ImageFormat::ktx2);
  EXPECT_EQ(header.state, ImageHeader::State::whole);
  EXPECT_EQ(header.width, 100U);
  EXPECT_EQ(header.height, 36U);
  EXPECT_EQ(read_image_header(whole.substr(0, 103)).state, ImageHeader::State::cut_off);
  EXPECT_EQ(read_image_header(whole.substr(0, 11)).format, ImageFormat::unknown);
}

TEST(Ktx2Colors, EqualTheDescriptor) {
  std::string bytes = file("uastc_linear_4x4");
  const std::size_t dfd = u32_at(bytes, kDfdOffset);
  EXPECT_EQ(read_ktx2_colors(bytes).value().encoding, ColorEncoding::linear);
  EXPECT_FALSE(read_ktx2_colors(bytes).value().is_premultiplied);
  EXPECT_EQ(read_ktx2_colors(file("etc1s_3x5")).value().encoding, ColorEncoding::srgb);
  bytes[dfd + kTransfer] = 3;
  bytes[dfd + kFlags] = 1;
  EXPECT_EQ(read_ktx2_colors(bytes).value().encoding, std::nullopt);
  EXPECT_TRUE(read_ktx2_colors(bytes).value().is_premultiplied);
  EXPECT_FALSE(read_ktx2_colors(bytes.substr(0, dfd + kFlags)));
  EXPECT_FALSE(read_ktx2_colors(bytes.substr(0, 50)));
}

}  // namespace
}  // namespace microtrace::io
