#include <microtrace/error.hpp>
#include <microtrace/primitives.hpp>

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
  // id as the next object. Has no branches, because they would often be mispredicted.
  const PrimitiveId* begin = first_ids_.data();
  for (std::size_t size = first_ids_.size(); size > 1;) {
    const std::size_t half = size / 2;
    begin = begin[half] <= id ? begin + half : begin;
    size -= half;
  }
  return static_cast<std::size_t>(begin - first_ids_.data());
}

}  // namespace microtrace
