#include "accel/resolve/open_side.hpp"

#include "base/bit_set.hpp"

#include <microtrace/surface_interaction.hpp>

namespace microtrace {

bool meets_open_side(const Primitives& primitives, const OpenSide& open, const Ray& ray,
                     PrimitiveId id) {
  return is_in(open.triangles, id) && shows_front(*primitives.triangle(id), ray.d) != open.is_back;
}

}  // namespace microtrace
