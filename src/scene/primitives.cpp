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
  for (const Object& object : scene.objects) {
    first_ids_.push_back(count_);
    const std::size_t more = primitive_count(object.shape);
    if (more > std::numeric_limits<PrimitiveId>::max() - count_)
      throw Error(ErrorKind::limit, "", "the scene has 2^32 primitives or more");
    count_ += static_cast<PrimitiveId>(more);
  }
  make_ranges();
}

void Primitives::make_ranges() {
  if (count_ == 0) return;
  const std::size_t most = std::max(kFewPrimitives, first_ids_.size());
  while ((count_ - 1) >> range_shift_ >= most) ++range_shift_;
  ranges_.resize(((count_ - 1) >> range_shift_) + std::size_t{1});
  const PrimitiveId mask = (PrimitiveId{1} << range_shift_) - 1;
  std::uint32_t object = 0;
  const auto advance_to = [&](PrimitiveId id) {
    while (object + 1 < first_ids_.size() && first_ids_[object + 1] <= id) ++object;
    return object;
  };
  PrimitiveId id = 0;
  for (ObjectRange& range : ranges_) {
    range.first = advance_to(id);
    range.count = advance_to(std::min(id | mask, count_ - 1)) - range.first + 1;
    id += mask + 1;
  }
}

std::size_t Primitives::find_object(const ObjectRange& range, PrimitiveId id) const {
  // Takes the last object that starts at or before `id`, because an empty mesh has the same first
  // id as the next object. Has no branches, because they would often be mispredicted.
  const PrimitiveId* begin = first_ids_.data() + range.first;
  for (std::uint32_t size = range.count; size > 1;) {
    const std::uint32_t half = size / 2;
    begin = begin[half] <= id ? begin + half : begin;
    size -= half;
  }
  return static_cast<std::size_t>(begin - first_ids_.data());
}

}  // namespace microtrace
