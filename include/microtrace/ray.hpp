#pragma once
/// The ray r(t) = o + t d and the interval in which it looks for hits.

#include <microtrace/math.hpp>

#include <limits>

namespace microtrace {

/// A query is valid if o and d are finite, d is not zero, and 0 <= t_min <= t_max with t_min
/// finite. Any other ray hits nothing. d need not have unit length; t counts in multiples of d.
struct Ray {
  Vec3 o{0};                                               ///< origin, world space
  float t_min = std::numeric_limits<float>::denorm_min();  ///< closed lower end; this default
                                                           ///< leaves out t = 0
  Vec3 d{0, 0, -1};                                        ///< direction, any length but zero
  float t_max = std::numeric_limits<float>::infinity();    ///< closed upper end
};

}  // namespace microtrace
