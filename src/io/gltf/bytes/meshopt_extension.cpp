#include "io/gltf/bytes/meshopt_extension.hpp"

#include "io/gltf/document/extension.hpp"

namespace microtrace::io::gltf {

std::optional<MeshoptObject> meshopt_object(const Element& holder) {
  for (const std::string_view name : {kKhrMeshopt, kExtMeshopt}) {
    if (const auto at = extension(holder, name)) return MeshoptObject{name, *at};
  }
  return std::nullopt;
}

}  // namespace microtrace::io::gltf
