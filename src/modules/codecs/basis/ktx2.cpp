#include "modules/codecs/basis/ktx2.hpp"

#include "modules/codecs/basis/texels.hpp"
#include "modules/codecs/basis/uastc.hpp"

#include <algorithm>
#include <bit>
#include <optional>
#include <string>
#include <string_view>

namespace basis {
namespace {

enum Scheme : std::uint32_t { none = 0, basis_lz = 1, zstandard = 2, zlib = 3 };

// Color models and channels of the Khronos Data Format Specification.
constexpr std::uint32_t kModelEtc1s = 163, kModelUastc = 166;
constexpr std::uint32_t kEtc1sRgb = 0, kEtc1sRrr = 3, kEtc1sGgg = 4, kEtc1sAaa = 15;
constexpr std::uint32_t kUastcRgb = 0, kUastcRgba = 3, kUastcRrr = 4, kUastcRrrg = 5, kUastcRg = 6;

[[noreturn]] void refuse(const std::string& what) {
  throw Damage("is KTX2 " + what +
               "; only 2D textures in ETC1S with BasisLZ or in UASTC are decoded "
               "(KHR_texture_basisu)");
}

void check_shape(Bytes file) {
  constexpr const char* kDamaged = "the KTX2 header is damaged";
  const std::uint32_t width = u32_at(file, 20), height = u32_at(file, 24);
  const std::uint32_t depth = u32_at(file, 28), layers = u32_at(file, 32);
  const std::uint32_t faces = u32_at(file, 36), levels = u32_at(file, 40);
  if (const std::uint32_t format = u32_at(file, 12); format != 0) {
    refuse("in Vulkan format " + std::to_string(format));
  }
  if (width == 0) throw Damage(kDamaged);
  if (height == 0) refuse("of one dimension");
  if (depth != 0) refuse("of three dimensions");
  if (layers != 0) refuse("with layers");
  if (faces != 1) refuse("with " + std::to_string(faces) + " faces");
  if (levels > static_cast<std::uint32_t>(std::bit_width(std::max(width, height)))) {
    throw Damage(kDamaged);
  }
}

/// Returns the channels of ETC1S, by those of its slices.
std::optional<Channels> etc1s_channels(std::size_t slices, std::uint32_t first,
                                       std::uint32_t second) {
  if (slices > 2 || (first != kEtc1sRgb && first != kEtc1sRrr)) return std::nullopt;
  if (slices < 2) return Channels::rgb;
  if (second == kEtc1sAaa) return Channels::rgba;
  if (first == kEtc1sRrr && second == kEtc1sGgg) return Channels::red_alpha;
  return std::nullopt;
}

std::optional<Channels> uastc_channels(std::size_t samples, std::uint32_t channel) {
  if (samples != 1) return std::nullopt;
  switch (channel) {
    case kUastcRgb:
    case kUastcRrr:
      return Channels::rgb;
    case kUastcRgba:
      return Channels::rgba;
    case kUastcRrrg:
      return Channels::red_alpha;
    case kUastcRg:
      return Channels::red_green;
    default:
      return std::nullopt;
  }
}

/// Reads the basic block of the data format descriptor.
void read_descriptor(Bytes file, Ktx2& ktx2) {
  constexpr const char* kDamaged = "the data format descriptor is damaged";
  const Bytes dfd = part_of(file, u32_at(file, 48), u32_at(file, 52), kDamaged);
  // Bytes before the samples, and bytes per sample.
  constexpr std::size_t kHeads = 28, kSampleSize = 16;
  if (dfd.size() < kHeads + kSampleSize || u32_at(dfd, 4) != 0) throw Damage(kDamaged);
  const std::uint32_t block_size = u32_at(dfd, 8) >> 16U;
  if (block_size < kHeads - 4 + kSampleSize || block_size > dfd.size() - 4) throw Damage(kDamaged);
  const std::size_t samples = (block_size - (kHeads - 4)) / kSampleSize;
  const auto channel = [&](std::size_t i) { return dfd[kHeads + i * kSampleSize + 3] & 0xFU; };

  const std::uint32_t model = dfd[12];
  if (model != kModelEtc1s && model != kModelUastc)
    refuse("in color model " + std::to_string(model));
  ktx2.format = model == kModelEtc1s ? TexelFormat::etc1s : TexelFormat::uastc;
  const std::optional<Channels> channels =
      model == kModelEtc1s ? etc1s_channels(samples, channel(0), samples > 1 ? channel(1) : 0)
                           : uastc_channels(samples, channel(0));
  if (!channels) refuse("with channels other than R, RG, RGB or RGBA");
  ktx2.channels = *channels;
}

/// Checks one metadata entry. Text values may end with a null byte.
void check_entry(Bytes entry) {
  const std::string_view text(reinterpret_cast<const char*>(entry.data()), entry.size());
  const std::size_t end = text.find('\0');
  if (end == std::string_view::npos) throw Damage("the metadata is damaged");
  const std::string_view key = text.substr(0, end);
  std::string_view value = text.substr(end + 1);
  if (value.ends_with('\0')) value.remove_suffix(1);
  if (key == "KTXorientation" && value != "rd") {
    refuse("whose first texel is not the upper left one (KTXorientation)");
  }
  if (key == "KTXswizzle" && value != "rgba") refuse("with swizzled channels (KTXswizzle)");
}

void check_metadata(Bytes file) {
  constexpr const char* kDamaged = "the metadata is damaged";
  Bytes left = part_of(file, u32_at(file, 56), u32_at(file, 60), kDamaged);
  while (left.size() >= 4) {
    const std::uint32_t size = u32_at(left, 0);
    check_entry(part_of(left, 4, size, kDamaged));
    const std::uint64_t padded = (std::uint64_t{size} + 3) / 4 * 4;
    left = left.subspan(std::min<std::size_t>(left.size(), 4 + padded));
  }
}

/// Locates the data of the first level, which is the largest.
void read_level(Bytes file, Ktx2& ktx2) {
  constexpr std::size_t kLevelIndex = 80;
  ktx2.levels = std::max(u32_at(file, 40), 1U);
  ktx2.level = part_of(file, number_at(file, kLevelIndex, 8), number_at(file, kLevelIndex + 8, 8),
                       "the base level is cut off");
  const std::uint32_t scheme = u32_at(file, 44);
  if (ktx2.format == TexelFormat::etc1s) {
    if (scheme != basis_lz) refuse("in ETC1S without BasisLZ");
    ktx2.global =
        part_of(file, number_at(file, 64, 8), number_at(file, 72, 8), "the global data is cut off");
    return;
  }
  if (scheme == zlib) refuse("in UASTC compressed by zlib");
  if (scheme != none && scheme != zstandard) {
    refuse("in UASTC with supercompression scheme " + std::to_string(scheme));
  }
  ktx2.is_zstd = scheme == zstandard;
  const std::uint64_t size =
      std::uint64_t{blocks_along(ktx2.width)} * blocks_along(ktx2.height) * kUastcBlockSize;
  if (number_at(file, kLevelIndex + 16, 8) != size ||
      (!ktx2.is_zstd && ktx2.level.size() != size)) {
    throw Damage("the base level does not have the size of its blocks");
  }
}

}  // namespace

Ktx2 read_ktx2(Bytes file) {
  check_shape(file);
  Ktx2 ktx2{.width = u32_at(file, 20), .height = u32_at(file, 24)};
  read_descriptor(file, ktx2);
  check_metadata(file);
  read_level(file, ktx2);
  return ktx2;
}

}  // namespace basis
