#include "io/gltf/check/schema/attribute_names.hpp"

#include <algorithm>
#include <array>

namespace microtrace::io::gltf {

bool is_attribute_name(std::string_view name) {
  constexpr std::array<std::string_view, 3> kSingle = {"POSITION", "NORMAL", "TANGENT"};
  constexpr std::array<std::string_view, 4> kSets = {"TEXCOORD_", "COLOR_", "JOINTS_", "WEIGHTS_"};
  if (name.starts_with('_') || std::ranges::find(kSingle, name) != kSingle.end()) return true;
  return std::ranges::any_of(kSets, [&](std::string_view set) {
    return name.starts_with(set) && name.size() > set.size() &&
           name.find_first_not_of("0123456789", set.size()) == std::string_view::npos &&
           (name[set.size()] != '0' || name.size() == set.size() + 1);
  });
}

bool is_instance_attribute_name(std::string_view name) {
  return name.starts_with('_') || name == "TRANSLATION" || name == "ROTATION" || name == "SCALE";
}

}  // namespace microtrace::io::gltf
