#include "io/gltf/extensions/extensions.hpp"

#include <algorithm>
#include <iterator>
#include <vector>

namespace microtrace::io::gltf {

const ExtensionObject* Extension::object_in(Place place) const {
  const auto found = std::ranges::find(objects, place, &ExtensionObject::place);
  return found != objects.end() ? &*found : nullptr;
}

std::span<const Extension> extensions() {
  static const std::vector<Extension> all = [] {
    std::vector<Extension> list;
    std::ranges::merge(material_extensions(), other_extensions(), std::back_inserter(list), {},
                       &Extension::name, &Extension::name);
    return list;
  }();
  return all;
}

const Extension* find_extension(std::string_view name) {
  const auto found = std::ranges::lower_bound(extensions(), name, {}, &Extension::name);
  return found != extensions().end() && found->name == name ? &*found : nullptr;
}

}  // namespace microtrace::io::gltf
