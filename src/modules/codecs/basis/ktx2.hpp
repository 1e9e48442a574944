#pragma once
/// The container: KTX File Format Specification 2.0, and what KHR_texture_basisu allows of it.

#include "modules/codecs/basis/bytes.hpp"

#include <cstdint>

namespace basis {

enum class TexelFormat { etc1s, uastc };

/// The base level of a 2D texture.
struct Ktx2 {
  std::uint32_t width = 0, height = 0;  ///< pixels, at least 1
  TexelFormat format = TexelFormat::etc1s;
  bool has_alpha = false;
  bool is_zstd = false;      ///< whether Zstandard compresses the level
  Bytes level{};             ///< the level's data
  Bytes global{};            ///< ETC1S: what all levels share
  std::uint32_t levels = 1;  ///< in the file
};

/// Throws Damage where the file is damaged, or holds anything but a 2D texture in ETC1S with
/// BasisLZ, or in UASTC as it is or compressed by Zstandard.
[[nodiscard]] Ktx2 read_ktx2(Bytes file);

}  // namespace basis
