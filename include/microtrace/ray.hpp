#pragma once
/// The ray r(t) = o + t d and its interval of t.

#include <microtrace/math.hpp>

#include <limits>

namespace microtrace {

/// A query is valid if o and d are finite, d is not zero, and 0 <= t_min <= t_max with finite
/// t_min. Other rays hit nothing. d need not have unit length; t is in multiples of d.
struct Ray {
  Vec3 o{0};                                               ///< origin, world space
  float t_min = std::numeric_limits<float>::denorm_min();  ///< closed lower end, above 0
  Vec3 d{0, 0, -1};                                        ///< direction, any nonzero length
  float t_max = std::numeric_limits<float>::infinity();    ///< closed upper end
};

}  // namespace microtrace
