#pragma once
/// What a KTX2 file says of its colors.

#include <microtrace/texture.hpp>

#include <optional>
#include <string_view>

namespace microtrace::io {

struct Ktx2Colors {
  std::optional<ColorEncoding> encoding{};  ///< nothing where it is neither sRGB nor linear
  bool is_premultiplied = false;            ///< by alpha
};

/// From the data format descriptor (KTX File Format Specification 2.0, section 3.10) of a file that
/// read_image_header takes for KTX2; nothing where it is damaged.
[[nodiscard]] std::optional<Ktx2Colors> read_ktx2_colors(std::string_view bytes);

}  // namespace microtrace::io
