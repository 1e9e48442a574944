#pragma once
/// Decodes image files.

#include <microtrace/texture.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace microtrace::io {

/// Maximum number of pixels of an image.
inline constexpr std::uint64_t kMaxTexturePixels = std::uint64_t{1} << 28U;

struct DecodedImage {
  std::optional<Image> image{};  ///< nothing if the file can't be decoded
  std::string complaint{};       ///< the reason of a failure, or a warning
  bool too_large = false;        ///< more than kMaxTexturePixels, or than the memory allows
  bool no_module = false;        ///< the codec module is not installed
};

/// Decodes PNG, JPEG, WebP or KTX2 with the codec module, which is loaded at the first call. The
/// size in the file's header is checked before memory is allocated. The same bytes give the same
/// pixels on every machine. Throws Error (limit) if the memory budget is exceeded.
[[nodiscard]] DecodedImage decode_image(std::string_view bytes);

}  // namespace microtrace::io
