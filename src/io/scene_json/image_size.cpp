#include "io/scene_json/image_size.hpp"

#include <algorithm>
#include <cstdint>

namespace microtrace::io {
namespace {

/// Reads the width or height of a picture. Numbers beyond the range of std::uint32_t become its
/// maximum, which validate() rejects.
std::uint32_t read_side(const JsonReader& json) {
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(json.count(), 0xFFFFFFFFU));
}

}  // namespace

ImageSize read_image_size(const JsonReader& json) {
  json.require_object({"width", "height"});
  const ImageSize size{.width = read_side(json.member("width")),
                       .height = read_side(json.member("height"))};
  json.require(validate(size));
  return size;
}

}  // namespace microtrace::io
