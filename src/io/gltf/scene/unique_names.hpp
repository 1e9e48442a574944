#pragma once
/// Makes the names of objects, cameras and lights unique.

#include <span>
#include <string>
#include <vector>

namespace microtrace::io::gltf {

/// Numbers names that occur before. For example, the second "Cube" becomes "Cube (2)".
void make_unique(std::span<std::string* const> names);

/// Does so for the members `name`.
template <class Named>
void make_names_unique(std::vector<Named>& all) {
  std::vector<std::string*> names;
  names.reserve(all.size());
  for (Named& named : all) names.push_back(&named.name);
  make_unique(names);
}

}  // namespace microtrace::io::gltf
