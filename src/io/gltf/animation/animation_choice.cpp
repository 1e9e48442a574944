#include "base/text/named_items.hpp"
#include "io/gltf/animation/animations.hpp"
#include "io/gltf/document/properties.hpp"

#include <numeric>
#include <string>

namespace microtrace::io::gltf {

std::vector<std::size_t> choose_animations(const Asset& asset, const std::string& wanted) {
  const std::vector<std::string> names = names_of(asset.array("animations"));
  if (wanted.empty())
    return names.empty() ? std::vector<std::size_t>{} : std::vector<std::size_t>{0};
  if (const auto index = find_item(wanted, names)) return {*index};
  if (wanted != "all")
    throw Error(ErrorKind::usage, asset.file(), no_such_item("animation", wanted, names));
  std::vector<std::size_t> all(names.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return all;
}

}  // namespace microtrace::io::gltf
