#pragma once
/// The KTX2 container (KTX File Format Specification 2.0), as far as KHR_texture_basisu allows.

#include "modules/codecs/basis/bytes.hpp"

#include <cstdint>

namespace basis {

enum class TexelFormat { etc1s, uastc };

/// The base level of a 2D texture.
struct Ktx2 {
  std::uint32_t width = 0, height = 0;  ///< pixels, at least 1
  TexelFormat format = TexelFormat::etc1s;
  bool has_alpha = false;
  bool is_zstd = false;      ///< true if the level is compressed by Zstandard
  Bytes level{};             ///< the level's data
  Bytes global{};            ///< ETC1S: data shared by all levels
  std::uint32_t levels = 1;  ///< in the file
};

/// Throws Damage if the file is damaged, or contains anything other than a 2D texture in ETC1S with
/// BasisLZ, or in UASTC, uncompressed or with Zstandard.
[[nodiscard]] Ktx2 read_ktx2(Bytes file);

}  // namespace basis
