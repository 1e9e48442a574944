#pragma once
/// Decodes image files.

#include <microtrace/texture.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace microtrace::io {

/// The maximum number of pixels of an image.
inline constexpr std::uint64_t kMaxTexturePixels = std::uint64_t{1} << 28U;

struct DecodedImage {
  std::optional<Image> image{};  ///< nothing if the file can't be decoded
  std::string complaint{};       ///< reason for a failure, or a warning
  bool too_large = false;        ///< more pixels than kMaxTexturePixels, or than memory allows
  bool no_module = false;        ///< true if the codec module is not installed
};

/// Decodes PNG, JPEG, WebP or KTX2 by the codec module, which is loaded at the first call. Checks
/// the size in the file's header before it allocates memory. The same bytes give the same pixels on
/// every machine. Throws Error (limit) if the memory budget is exceeded.
[[nodiscard]] DecodedImage decode_image(std::string_view bytes);

}  // namespace microtrace::io
