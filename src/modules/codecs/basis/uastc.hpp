#pragma once
/// Decodes UASTC LDR 4x4 ("UASTC LDR 4x4 Texture Specification", Basis Universal, Binomial LLC).
/// This format builds on ASTC (Khronos Data Format Specification 1.3, chapter 23).

#include "modules/codecs/basis/bytes.hpp"
#include "modules/codecs/basis/texels.hpp"

#include <cstddef>

namespace basis {

inline constexpr std::size_t kUastcBlockSize = 16;  // bytes

/// Decodes a block of kUastcBlockSize bytes to linear 8-bit texels. Throws Damage.
[[nodiscard]] Block decode_uastc_block(Bytes bytes);

}  // namespace basis
