#pragma once
/// Reads the color encoding of a KTX2 file.

#include <microtrace/texture.hpp>

#include <optional>
#include <string_view>

namespace microtrace::io {

struct Ktx2Colors {
  std::optional<ColorEncoding> encoding{};  ///< nothing if it is neither sRGB nor linear
  bool is_premultiplied = false;            ///< true if colors are premultiplied by alpha
};

/// Reads the data format descriptor (KTX File Format Specification 2.0, section 3.10) of a file
/// that read_image_header recognizes as KTX2. Returns nothing if the descriptor is damaged.
[[nodiscard]] std::optional<Ktx2Colors> read_ktx2_colors(std::string_view bytes);

}  // namespace microtrace::io
