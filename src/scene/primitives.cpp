#include <microtrace/error.hpp>
#include <microtrace/primitives.hpp>

#include <algorithm>
#include <limits>

namespace microtrace {
namespace {

/// In scenes with up to this number of primitives, each range consists of a single primitive.
constexpr std::size_t kFewPrimitives = 1024;

}  // namespace

Primitives::Primitives(const Scene& scene)
    : scene_(&scene), is_run_single_(scene.objects.runs().size() == scene.objects.size()) {
  first_ids_.reserve(scene.objects.runs().size() + 1);
  for (const ObjectRun& run : scene.objects.runs()) {
    first_ids_.push_back(count_);
    const std::uint64_t more = primitive_count(run);
    if (more > std::numeric_limits<PrimitiveId>::max() - count_)
      throw Error(ErrorKind::limit, "", "the scene has 2^32 primitives or more");
    count_ += static_cast<PrimitiveId>(more);
  }
  first_ids_.push_back(count_);
  make_ranges();
}

void Primitives::make_ranges() {
  if (count_ == 0) return;
  const std::size_t runs = first_ids_.size() - 1;
  const std::size_t most = std::max(kFewPrimitives, runs);
  while ((count_ - 1) >> range_shift_ >= most) ++range_shift_;
  range_runs_.resize(((count_ - 1) >> range_shift_) + std::size_t{2});
  std::uint32_t run = 0;
  const auto run_of = [&](PrimitiveId id) {
    while (run + 1 < runs && first_ids_[run + 1] <= id) ++run;
    return run;
  };
  for (std::size_t i = 0; i + 1 < range_runs_.size(); ++i)
    range_runs_[i] = run_of(static_cast<PrimitiveId>(i << range_shift_));
  range_runs_.back() = run_of(count_ - 1);
}

std::size_t Primitives::find_run(std::uint32_t first, std::uint32_t last, PrimitiveId id) const {
  // Takes the last run that starts at or before `id`, because an empty mesh has the same first id
  // as the next object. Has no branches, because they would often be mispredicted.
  const PrimitiveId* begin = first_ids_.data() + first;
  for (std::uint32_t size = last - first + 1; size > 1;) {
    const std::uint32_t half = size / 2;
    begin = begin[half] <= id ? begin + half : begin;
    size -= half;
  }
  return static_cast<std::size_t>(begin - first_ids_.data());
}

PlacedObject Primitives::object_in(const ObjectRun& own, std::size_t run, PrimitiveId id) const {
  const auto size = static_cast<PrimitiveId>(primitive_count(own.first->shape));
  const PrimitiveId place = (id - first_ids_[run]) / size;
  const PrimitiveId first = first_ids_[run] + place * size;
  return {.index = own.begin + place,
          .run = run,
          .first = own.first,
          .mesh = own.mesh(place),
          .first_id = first,
          .end_id = first + size};
}

PrimitiveId Primitives::first_id_of(std::size_t object) const {
  const std::size_t run = scene_->objects.run_of(object);
  const ObjectRun own = scene_->objects.run(run);
  if (own.count == 1) return first_ids_[run];
  return first_ids_[run] +
         static_cast<PrimitiveId>((object - own.begin) * primitive_count(own.first->shape));
}

}  // namespace microtrace
