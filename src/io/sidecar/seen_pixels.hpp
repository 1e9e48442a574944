#pragma once
/// Counts the pixels in which each object of a picture is visible, and finds their bounding boxes.

#include <microtrace/film.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace microtrace::io {

struct SeenPixels {
  std::uint64_t count = 0;
  PixelRect box{};  ///< coordinates are relative to the whole picture
};

/// Returns an item for each object of the scene. Returns nothing if the film has no channel
/// "id.instance".
[[nodiscard]] std::optional<std::vector<SeenPixels>> find_seen_pixels(const Film& film,
                                                                      std::size_t objects);

}  // namespace microtrace::io
