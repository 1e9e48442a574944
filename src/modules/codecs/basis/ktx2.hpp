#pragma once
/// The subset of the KTX2 container (KTX File Format Specification 2.0) that KHR_texture_basisu
/// allows.

#include "modules/codecs/basis/bytes.hpp"

#include <cstdint>

namespace basis {

enum class TexelFormat { etc1s, uastc };

/// The channels of texels, and how the formats store them.
enum class Channels {
  rgb,
  rgba,
  red_green,  ///< the first two color channels
  red_alpha,  ///< red and green, in the place of color and alpha
};

/// The base level of a 2D texture.
struct Ktx2 {
  std::uint32_t width = 0, height = 0;  ///< pixels, at least 1
  TexelFormat format = TexelFormat::etc1s;
  Channels channels = Channels::rgb;
  bool is_zstd = false;      ///< true if the level is compressed by Zstandard
  Bytes level{};             ///< the level's data
  Bytes global{};            ///< data shared by all levels, for ETC1S
  std::uint32_t levels = 1;  ///< number of levels in the file
};

/// Reads the container's structure. Throws Damage if the file is damaged. Also throws it unless the
/// file contains a 2D texture that is either ETC1S with BasisLZ, or UASTC without supercompression
/// or with Zstandard.
[[nodiscard]] Ktx2 read_ktx2(Bytes file);

}  // namespace basis
