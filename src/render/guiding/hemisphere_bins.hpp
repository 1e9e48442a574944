#pragma once
#include "scene/math/revolutions.hpp"

#include <microtrace/math.hpp>

#include <algorithm>
#include <cmath>

namespace microtrace {

/// A direction along a coordinate axis.
struct SignedAxis {
  int axis = 2;          ///< 0 to 2
  bool is_down = false;  ///< true if the direction is negative

  /// The axis from which a unit vector deviates least.
  [[nodiscard]] static SignedAxis nearest(const Vec3& n) {
    const Vec3 size(std::abs(n.x), std::abs(n.y), std::abs(n.z));
    const int axis = size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
    return {.axis = axis, .is_down = n[axis] < 0};
  }
  [[nodiscard]] Vec3 direction() const {
    Vec3 d(0);
    d[axis] = is_down ? -1.0F : 1.0F;
    return d;
  }
};

/// The hemisphere about an axis, divided into bins of equal solid angle: rows of equal height, and
/// columns of equal longitude.
class HemisphereBins {
 public:
  static constexpr int kRows = 12, kColumns = 24, kCount = kRows * kColumns;

  explicit HemisphereBins(const SignedAxis& about) : about_(about) {}

  /// The cosine to the axis in the middle of a bin.
  [[nodiscard]] static float cosine(int bin) {
    return (static_cast<float>(bin / kColumns) + 0.5F) / kRows;
  }
  /// The unit direction at a position in [0, 1)^2 within a bin. Uniform positions give uniform
  /// directions.
  [[nodiscard]] Vec3 direction(int bin, const Vec2& place) const {
    const float height = (static_cast<float>(bin / kColumns) + place.x) / kRows;
    const SineCosine turn =
        sin_cos_revolutions((static_cast<float>(bin % kColumns) + place.y) / kColumns);
    const float range = std::sqrt((1 - height) * (1 + height));
    Vec3 d;
    d[about_.axis] = about_.is_down ? -height : height;
    d[(about_.axis + 1) % 3] = range * turn.cosine;
    d[(about_.axis + 2) % 3] = range * turn.sine;
    return d;
  }
  /// The bin of a unit direction; -1 below the hemisphere.
  [[nodiscard]] int bin(const Vec3& d) const { return place(d).bin; }

  struct Place {
    int bin;      ///< -1 below the hemisphere
    Vec2 within;  ///< the position within the bin, at most 1
  };
  /// The inverse of direction().
  [[nodiscard]] Place place(const Vec3& d) const {
    const float height = about_.is_down ? -d[about_.axis] : d[about_.axis];
    if (!(height > 0)) return {.bin = -1, .within = Vec2(0)};
    const float turn = atan2_revolutions(d[(about_.axis + 2) % 3], d[(about_.axis + 1) % 3]);
    const float y = height * kRows, x = chosen<1>(turn < 0, turn + 1, turn) * kColumns;
    const int row = std::min(static_cast<int>(y), kRows - 1);
    const int column = std::min(static_cast<int>(x), kColumns - 1);
    return {.bin = row * kColumns + column,
            .within = {y - static_cast<float>(row), x - static_cast<float>(column)}};
  }

 private:
  SignedAxis about_;
};

}  // namespace microtrace
