#pragma once
/// Spawned origins by float64 alone, where that is sure: nearly always, and much sooner.

#include "accel/filters/triangle_filter.hpp"
#include "accel/kernels/kernel.hpp"

#include <microtrace/hit.hpp>
#include <microtrace/ray.hpp>
#include <microtrace/shape.hpp>

#include <optional>

namespace microtrace {

/// The point where a ray hits a triangle, for rays that leave it. Answers are spawn_among's.
class QuickSpawn {
 public:
  /// `ray` hits the triangle, which bears that number.
  QuickSpawn(const Triangle& triangle, PrimitiveId id, const Ray& ray);

  /// Whether it is sure that no other surface of the tree comes near the point. To be asked before
  /// origin().
  [[nodiscard]] bool is_alone(const Kernels& kernels, const TreeView& tree) const;

  /// Nothing if float64 can't tell.
  [[nodiscard]] std::optional<Vec3> origin(const Vec3& direction) const;

 private:
  Vec3 a_;
  CrossProduct normal_;
  PrimitiveId id_;
  std::optional<Vec3> p_;  // rounded; nothing: not sure
  double reach_ = 0;       // origins lie so near to p_, axis by axis
  int axis_ = 0;           // along which origins are moved
};

}  // namespace microtrace
