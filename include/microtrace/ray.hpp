#pragma once
/// The ray r(t) = o + t d and its interval of t.

#include <microtrace/math.hpp>

#include <limits>

namespace microtrace {

/// A ray is valid if o and d are finite, d is not zero, t_min is finite, and 0 <= t_min <= t_max.
/// Other rays hit nothing. d need not have unit length; t counts multiples of d. The members are in
/// world space unless a function asks for scene coordinates.
struct Ray {
  Vec3 o{0};                                               ///< origin
  float t_min = std::numeric_limits<float>::denorm_min();  ///< closed lower end; by default, the
                                                           ///< smallest float32 above 0
  Vec3 d{0, 0, -1};                                        ///< direction, any nonzero length
  float t_max = std::numeric_limits<float>::infinity();    ///< closed upper end; may be infinite
};

}  // namespace microtrace
