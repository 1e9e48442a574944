#include <microtrace/error.hpp>
#include <microtrace/primitives.hpp>

#include <algorithm>
#include <limits>

namespace microtrace {

Primitives::Primitives(const Scene& scene) : scene_(&scene) {
  std::size_t next = 0;
  for (const Object& object : scene.objects) {
    first_ids_.push_back(static_cast<PrimitiveId>(next));
    next += primitive_count(object.shape);
    if (next > std::numeric_limits<PrimitiveId>::max())
      throw Error(ErrorKind::limit, "", "the scene has 2^32 primitives or more");
  }
}

std::size_t Primitives::object_index(PrimitiveId id) const {
  // Empty meshes share their number with the object after them: the last of those that begin at or
  // before id.
  const auto after = std::upper_bound(first_ids_.begin(), first_ids_.end(), id);
  return static_cast<std::size_t>(after - first_ids_.begin()) - 1;
}

}  // namespace microtrace
