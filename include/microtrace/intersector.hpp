#pragma once
/// The nearest hit of a ray with a scene.

#include <microtrace/hit.hpp>
#include <microtrace/primitives.hpp>
#include <microtrace/ray.hpp>
#include <microtrace/scene.hpp>

#include <optional>
#include <span>

namespace microtrace {

/// Asks every primitive of a scene. Immutable; any number of threads may use one at a time.
///
/// The answer is the hit that is least by (t, PrimitiveId) over the real numbers, for the float32
/// numbers that scene and ray hold: no rounding, no order of evaluation and no compiler can change
/// it. docs/exactness.md says how.
class Intersector {
 public:
  /// The scene must outlive the intersector and stay as it is.
  explicit Intersector(const Scene& scene) : primitives_(scene) {}

  /// Nothing if the ray hits nothing or is not valid (see Ray).
  [[nodiscard]] std::optional<Hit> intersect(const Ray& ray) const;

  /// The same for many rays at once: hits[i] answers rays[i]; both have one length. Much faster
  /// where all rays start at one point, as those of a perspective camera do.
  void intersect(std::span<const Ray> rays, std::span<std::optional<Hit>> hits) const;

  [[nodiscard]] const Primitives& primitives() const { return primitives_; }

 private:
  Primitives primitives_;
};

}  // namespace microtrace
