#pragma once
/// Visible pixels and bounding boxes of objects in a picture.

#include <microtrace/film.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace microtrace::io {

struct SeenPixels {
  std::uint64_t count = 0;
  PixelRect box{};  ///< in the whole picture
};

/// For each object of the scene; nothing if the film has no channel "id.instance".
[[nodiscard]] std::optional<std::vector<SeenPixels>> find_seen_pixels(const Film& film,
                                                                      std::size_t objects);

}  // namespace microtrace::io
