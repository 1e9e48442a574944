#include "render/prepared/one_sided_triangles.hpp"

#include <cstddef>
#include <variant>

namespace microtrace {

OneSidedTriangles::OneSidedTriangles(const Scene& scene, const Primitives& primitives)
    : PrimitiveSet(primitives.count(), "the one-sided surfaces of the scene") {
  std::size_t run = 0;
  for (const ObjectRun& objects : scene.objects.runs()) {
    const PrimitiveId first = primitives.first_id_of_run(run);
    const PrimitiveId end = primitives.first_id_of_run(++run);
    const Object& object = *objects.first;
    if (std::holds_alternative<Mesh>(object.shape) && !material_of(scene, object).double_sided)
      insert(first, end);
  }
}

}  // namespace microtrace
