#pragma once
/// Pointers of KHR_animation_pointer.

#include "io/gltf/document/asset.hpp"

#include <string>
#include <string_view>

namespace microtrace::io::gltf {

/// Why a text points to nothing that could be animated in the asset: it is no JSON pointer (RFC
/// 6901), or it leads beyond the end of an array or to an array that is not there. Empty where it
/// may be good: properties may be absent, where they have defaults.
[[nodiscard]] std::string why_no_pointer(const Asset& asset, std::string_view text);

}  // namespace microtrace::io::gltf
