#include "explain/primitive.hpp"

#include "accel/resolve/exact_hits.hpp"
#include "accel/resolve/hit_resolver.hpp"
#include "exact/numbers/round_to_double.hpp"
#include "explain/numbers.hpp"
#include "scene/shape_name.hpp"

namespace microtrace {
namespace {

/// Returns the last stage that took part in tests.
Stage last_stage(const StageCounts& tests) {
  if (tests.dyadic > 0) return Stage::dyadic;
  if (tests.grid > 0) return Stage::grid;
  return tests.filters > 0 || tests.edges > 0 ? Stage::float64 : Stage::float32;
}

template <class Work>
Stage stage_during(const Work& work) {
  const StageCounts before = stage_counts();
  (void)work();
  return last_stage(stage_counts() - before);
}

}  // namespace

PrimitiveStages stages_of(const TracedRay& traced, PrimitiveId id) {
  Scene alone;
  traced.bvh.primitives().visit(
      id, [&](const auto& shape) { alone.objects.push_back({.name = {}, .shape = shape}); });
  const Bvh bvh(alone, {.threads = 1});
  return {.hit = stage_during([&] { return bvh.occluded(traced.ray); }),
          .t = stage_during([&] { return bvh.intersect(traced.ray); })};
}

ExplainedPrimitive explain_primitive(const TracedRay& traced, PrimitiveId id, Stage decided_by) {
  const Primitives& primitives = traced.bvh.primitives();
  const PlacedObject object = primitives.object_of(id);
  return {.id = id,
          .object = object.index,
          .name = primitives.scene().objects.name(object.index).str(),
          .primitive = id - object.first_id,
          .type = type_name(object.first->shape),
          .numbers = intersection_numbers(primitives, traced.ray, id),
          .decided_by = decided_by,
          .derivation = derivation_of(primitives, id)};
}

OrderDecision order_of(const TracedRay& traced, PrimitiveId first, PrimitiveId second) {
  const Primitives& primitives = traced.bvh.primitives();
  const ExactHits exactly(primitives, traced.ray);
  const HitResolver resolver(primitives, traced.ray);
  const auto bounds = [&](PrimitiveId id) {
    const FilterResult filtered = resolver.filtered(id);
    if (filtered.certainty == Certainty::hit)
      return exact::Enclosure{.lo = filtered.lo, .hi = filtered.hi};
    return *exactly.bounds(id);
  };
  if (bounds(first).hi < bounds(second).lo) return OrderDecision::bounds;
  return exactly.order(first, second) == 0 ? OrderDecision::tie : OrderDecision::exact;
}

double exact_t(const TracedRay& traced, PrimitiveId id) {
  return exact::round_to_double(*ExactHits(traced.bvh.primitives(), traced.ray).root(id));
}

bool is_at(const TracedRay& traced, PrimitiveId id, float t) {
  return *ExactHits(traced.bvh.primitives(), traced.ray).root(id) == exact::rational(t);
}

}  // namespace microtrace
