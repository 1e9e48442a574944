#pragma once
/// Validates the pointers of KHR_animation_pointer.

#include "io/gltf/document/asset.hpp"

#include <string>
#include <string_view>

namespace microtrace::io::gltf {

/// Returns the reason why a text can't point to an animated property: it is not a JSON pointer (RFC
/// 6901), it leads past the end of an array, or the array is absent. Returns an empty text if the
/// pointer may be valid. The property itself may be absent, because it may have a default.
[[nodiscard]] std::string why_no_pointer(const Asset& asset, std::string_view text);

}  // namespace microtrace::io::gltf
