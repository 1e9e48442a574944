#pragma once
#include "render/guiding/hemisphere_lanes.hpp"

#include <microtrace/math.hpp>

#include <cstddef>

namespace microtrace {

/// A direction along a coordinate axis.
struct SignedAxis {
  int axis = 2;          ///< 0 to 2
  bool is_down = false;  ///< true if the direction is negative

  /// The axis of a face_index().
  [[nodiscard]] static SignedAxis of_face(std::size_t face) {
    return {.axis = static_cast<int>(face / 2), .is_down = face % 2 != 0};
  }
  /// The axis from which a unit vector deviates least.
  [[nodiscard]] static SignedAxis nearest(const Vec3& n) {
    return of_face(static_cast<std::size_t>(nearest_face<1>(n)));
  }
  [[nodiscard]] Vec3 direction() const {
    Vec3 d(0);
    d[axis] = is_down ? -1.0F : 1.0F;
    return d;
  }
};

/// A number from 0 to 5 for each SignedAxis.
[[nodiscard]] inline std::size_t face_index(const SignedAxis& axis) {
  return 2 * static_cast<std::size_t>(axis.axis) + (axis.is_down ? 1 : 0);
}

/// HemisphereLanes for one direction.
class HemisphereBins : public HemisphereGrid {
 public:
  explicit HemisphereBins(const SignedAxis& about)
      : lanes_{.axis = about.axis, .sign = about.is_down ? -1.0F : 1.0F} {}

  /// The cosine to the axis in the middle of a bin.
  [[nodiscard]] static float cosine(int bin) {
    const int row = bin / kColumns;
    return (static_cast<float>(row) + 0.5F) / kRows;
  }
  /// The unit direction at a position in [0, 1)^2 within a bin.
  [[nodiscard]] Vec3 direction(int bin, const Vec2& place) const {
    const int row = bin / kColumns, column = bin % kColumns;
    return lanes_.direction(static_cast<float>(row) + place.x,
                            static_cast<float>(column) + place.y);
  }
  /// The bin of a unit direction; -1 below the hemisphere.
  [[nodiscard]] int bin(const Vec3& d) const { return place(d).bin; }

  struct Place {
    int bin;      ///< -1 below the hemisphere
    Vec2 within;  ///< the position within the bin, at most 1
  };
  /// The inverse of direction().
  [[nodiscard]] Place place(const Vec3& d) const {
    const auto place = lanes_.place(d);
    return {.bin = place.bin, .within = {place.row, place.column}};
  }

 private:
  HemisphereLanes<1> lanes_;
};

}  // namespace microtrace
