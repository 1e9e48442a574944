#include <microtrace/error.hpp>
#include <microtrace/primitives.hpp>

#include <algorithm>
#include <limits>

namespace microtrace {
namespace {

/// In scenes with up to this number of primitives, each range consists of a single primitive.
constexpr std::size_t kFewPrimitives = 1024;

}  // namespace

Primitives::Primitives(const Scene& scene) : scene_(&scene) {
  first_ids_.reserve(scene.objects.size() + 1);
  for (const Object& object : scene.objects) {
    first_ids_.push_back(count_);
    const std::size_t more = primitive_count(object.shape);
    if (more > std::numeric_limits<PrimitiveId>::max() - count_)
      throw Error(ErrorKind::limit, "", "the scene has 2^32 primitives or more");
    count_ += static_cast<PrimitiveId>(more);
  }
  first_ids_.push_back(count_);
  make_ranges();
}

void Primitives::make_ranges() {
  if (count_ == 0) return;
  const std::size_t objects = scene_->objects.size();
  const std::size_t most = std::max(kFewPrimitives, objects);
  while ((count_ - 1) >> range_shift_ >= most) ++range_shift_;
  range_objects_.resize(((count_ - 1) >> range_shift_) + std::size_t{2});
  std::uint32_t object = 0;
  const auto object_of = [&](PrimitiveId id) {
    while (object + 1 < objects && first_ids_[object + 1] <= id) ++object;
    return object;
  };
  for (std::size_t i = 0; i + 1 < range_objects_.size(); ++i)
    range_objects_[i] = object_of(static_cast<PrimitiveId>(i << range_shift_));
  range_objects_.back() = object_of(count_ - 1);
}

std::size_t Primitives::find_object(std::uint32_t first, std::uint32_t last, PrimitiveId id) const {
  // Takes the last object that starts at or before `id`, because an empty mesh has the same first
  // id as the next object. Has no branches, because they would often be mispredicted.
  const PrimitiveId* begin = first_ids_.data() + first;
  for (std::uint32_t size = last - first + 1; size > 1;) {
    const std::uint32_t half = size / 2;
    begin = begin[half] <= id ? begin + half : begin;
    size -= half;
  }
  return static_cast<std::size_t>(begin - first_ids_.data());
}

}  // namespace microtrace
