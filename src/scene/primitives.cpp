#include <microtrace/error.hpp>
#include <microtrace/primitives.hpp>

#include <algorithm>
#include <limits>

namespace microtrace {

Primitives::Primitives(const Scene& scene) : scene_(&scene) {
  for (const Object& object : scene.objects) {
    first_ids_.push_back(count_);
    const std::size_t more = primitive_count(object.shape);
    if (more > std::numeric_limits<PrimitiveId>::max() - count_)
      throw Error(ErrorKind::limit, "", "the scene has 2^32 primitives or more");
    count_ += static_cast<PrimitiveId>(more);
  }
}

std::size_t Primitives::object_index(PrimitiveId id) const {
  // Takes the last object that starts at or before `id`, because an empty mesh has the same first
  // id as the next object.
  const auto after = std::upper_bound(first_ids_.begin(), first_ids_.end(), id);
  return static_cast<std::size_t>(after - first_ids_.begin()) - 1;
}

}  // namespace microtrace
