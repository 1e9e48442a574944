#include <microtrace/scene.hpp>

namespace microtrace {

std::size_t primitive_count(const Shape& shape) {
  const auto* mesh = std::get_if<Mesh>(&shape);
  return mesh != nullptr ? mesh->triangles.size() : 1;
}

}  // namespace microtrace
