#pragma once
/// From the bytes of an image file to its pixels.

#include <microtrace/texture.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace microtrace::io {

/// No image has more pixels.
inline constexpr std::uint64_t max_texture_pixels = std::uint64_t{1} << 28U;

struct DecodedImage {
  std::optional<Image> image{};  ///< nothing where the file can't be decoded
  std::string complaint{};       ///< why not; or what is wrong with the file nevertheless
  bool too_large = false;        ///< more than max_texture_pixels, or than there is memory for
  bool no_module = false;        ///< the module of decoders is not installed
};

/// PNG, JPEG, WebP or KTX2, by the module of decoders, which is loaded at the first call. The size
/// that the file claims is checked before memory is taken for it. The same bytes give the same
/// pixels on every machine. Throws Error (limit) where the memory budget does not allow it.
[[nodiscard]] DecodedImage decode_image(std::string_view bytes);

}  // namespace microtrace::io
