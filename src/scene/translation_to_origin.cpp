#include "scene/translation_to_origin.hpp"

#include <algorithm>
#include <cmath>

namespace microtrace {

DVec3 translation_to_origin(const PointBounds& bounds) {
  // Below this ratio of distance to size, float32 resolves the scene with at least 20 bits anyway.
  constexpr double kFar = 16;
  const DVec3 middle = (bounds.low + bounds.high) * 0.5, half = (bounds.high - bounds.low) * 0.5;
  const double size = std::max({half.x, half.y, half.z});
  DVec3 way(0);
  if (size == 0) return way - middle;
  if (!(size > 0 && size < 0x1p60)) return way;
  int exponent = 0;
  std::frexp(size, &exponent);
  const double step = std::ldexp(1.0, exponent);
  for (int k = 0; k < 3; ++k) {
    if (std::abs(middle[k]) > kFar * size) way[k] = -step * std::round(middle[k] / step);
  }
  return way;
}

}  // namespace microtrace
