#include <microtrace/scene.hpp>

namespace microtrace {

const Material& material_of(const Scene& scene, const Object& object) {
  static const Material plain;
  return object.material ? scene.materials[*object.material] : plain;
}

std::size_t primitive_count(const Shape& shape) {
  const auto* mesh = std::get_if<Mesh>(&shape);
  return mesh != nullptr ? mesh->triangles.size() : 1;
}

std::size_t primitive_count(const ObjectRun& run) {
  return run.count * primitive_count(run.first->shape);
}

}  // namespace microtrace
