#pragma once
/// Explains how a ray meets one primitive.

#include <microtrace/bvh.hpp>
#include <microtrace/explain.hpp>
#include <microtrace/ray.hpp>

namespace microtrace {

/// A ray and the tree of its scene, both in scene coordinates. Both must outlive this object.
struct TracedRay {
  const Bvh& bvh;
  const Ray& ray;
};

/// The stages of the test of a ray with one primitive.
struct PrimitiveStages {
  Stage hit = Stage::float32;  ///< decided whether the ray hits
  Stage t = Stage::float32;    ///< decided this and rounded t
};

/// Finds the stages by tracing the ray through a scene that contains only this primitive.
[[nodiscard]] PrimitiveStages stages_of(const TracedRay& traced, PrimitiveId id);

[[nodiscard]] ExplainedPrimitive explain_primitive(const TracedRay& traced, PrimitiveId id,
                                                   Stage decided_by);

/// Returns how the order of two hits in succession was decided.
[[nodiscard]] OrderDecision order_of(const TracedRay& traced, PrimitiveId first,
                                     PrimitiveId second);

/// Returns the exact t of the hit with a primitive, which must exist, rounded to float64.
[[nodiscard]] double exact_t(const TracedRay& traced, PrimitiveId id);

/// Returns true if the hit with a primitive, which must exist, is exactly at t.
[[nodiscard]] bool is_at(const TracedRay& traced, PrimitiveId id, float t);

}  // namespace microtrace
