#pragma once
/// The rays through a rectangle of a picture.

#include <microtrace/hit.hpp>
#include <microtrace/math.hpp>

#include <optional>

namespace microtrace {

/// Rays with the common origin `o`. The direction of each ray is middle + s half_right +
/// t half_down for some s and t in [-1, 1], scaled to unit length and rounded to float32.
struct Frustum {
  Vec3 o{0};
  DVec3 middle{0}, half_right{0}, half_down{0};
  double error = 0;  ///< upper bound of the error of middle + s half_right + t half_down
  double greatest_t_min = 0, least_t_max = 0;  ///< bounds of the rays' intervals
};

/// What the rays of a frustum hit first, if they all hit the same primitive.
struct CommonHit {
  bool is_known = false;
  std::optional<PrimitiveId> id{};  ///< the primitive; nothing if all rays miss. Valid if is_known.
};

}  // namespace microtrace
