#pragma once
/// Makes the names of objects, cameras and lights unique.

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace microtrace::io::gltf {

/// Numbers names that occur before. For example, the second "Cube" becomes "Cube (2)". `name`
/// returns the name with an index below `count`, and `rename` changes it.
void make_unique(std::size_t count, const std::function<std::string(std::size_t)>& name,
                 const std::function<void(std::size_t, const std::string&)>& rename);

/// Does so for the members `name`.
template <class Named>
void make_names_unique(std::vector<Named>& all) {
  make_unique(
      all.size(),
      [&](std::size_t i) {
        if constexpr (requires { all[i].name.str(); })
          return all[i].name.str();
        else
          return all[i].name;
      },
      [&](std::size_t i, const std::string& name) { all[i].name = name; });
}

}  // namespace microtrace::io::gltf
