#pragma once
/// The place of a mesh in a scene, for meshes that several objects share.

#include <microtrace/export.hpp>
#include <microtrace/math.hpp>

namespace microtrace {

/// An affine transform from a mesh's own space to scene coordinates. Points are transformed in
/// float64 by + and *, in the order that `coordinate` states, and rounded once. The vertices of a
/// shared mesh are therefore the float32 numbers that a transformed copy of the mesh would store.
class MICROTRACE_EXPORT Placement {
 public:
  /// The last row of the matrix is ignored.
  explicit Placement(const DMat4& scene_from_mesh);

  /// Returns M p + t.
  [[nodiscard]] DVec3 point(const DVec3& p) const {
    return {coordinate(0, p), coordinate(1, p), coordinate(2, p)};
  }
  /// Returns one coordinate of M p + t, which is (M0 x + M1 y) + (M2 z + t).
  [[nodiscard]] double coordinate(int axis, const DVec3& p) const {
    return (columns_[0][axis] * p.x + columns_[1][axis] * p.y) +
           (columns_[2][axis] * p.z + columns_[3][axis]);
  }
  /// Returns the unit normal of a transformed surface: the inverse transpose of M times n,
  /// normalized. Zero if the result has no direction.
  [[nodiscard]] DVec3 normal(const DVec3& n) const;
  /// Returns M v, normalized. Zero if the result has no direction.
  [[nodiscard]] DVec3 direction(const DVec3& v) const;
  /// True if the transform reverses orientation, and is not flat but for rounding. Two corners of
  /// each triangle are then exchanged, so that front faces remain front faces (glTF 2.0,
  /// section 3.7.4).
  [[nodiscard]] bool is_mirrored() const;

  /// Returns column k of M, or t for k = 3.
  [[nodiscard]] const DVec3& column(int k) const { return columns_[k]; }

 private:
  // A scene may have millions of placements, so they hold only these.
  DVec3 columns_[4];
};

}  // namespace microtrace
