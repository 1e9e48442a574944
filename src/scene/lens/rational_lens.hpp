#pragma once
#include "scene/lens/lens_differential.hpp"

#include <microtrace/camera.hpp>
#include <microtrace/math.hpp>

#include <optional>

namespace microtrace {

/// Applies and inverts RationalDistortion; see Lens.
class RationalLens {
 public:
  explicit RationalLens(const RationalDistortion& k);

  [[nodiscard]] std::optional<DVec3> direction(const DVec2& image) const;
  [[nodiscard]] std::optional<DVec2> image(const DVec3& direction) const;
  [[nodiscard]] LensDifferential differential(const DVec3& d) const;

 private:
  /// The factor of the radial distortion at r^2 = s, and its derivative with respect to s.
  struct Radial {
    double factor, slope;
  };
  [[nodiscard]] Radial radial(double s) const;
  [[nodiscard]] DVec2 distorted(const DVec2& u) const;
  /// The derivatives of distorted(u), a symmetric matrix [xx, xy; xy, yy].
  struct Jacobian {
    double xx, xy, yy;
    [[nodiscard]] double determinant() const { return xx * yy - xy * xy; }
    /// The solution of J v = w.
    [[nodiscard]] DVec2 solve(const DVec2& w) const;
  };
  [[nodiscard]] Jacobian jacobian(const DVec2& u) const;
  [[nodiscard]] double invertible_radius() const;
  /// Inverts the radial distortion without the tangential part. The result is at most max_radius_.
  [[nodiscard]] double undistorted_radius(double distorted_radius) const;
  /// Solves distorted(u) = image by Newton's method, starting at u, which must be in the disk of
  /// radius max_radius_.
  [[nodiscard]] std::optional<DVec2> undistorted(const DVec2& image, DVec2 u) const;

  RationalDistortion k_;
  double max_radius_;     // greatest radius of undistorted points
  double max_distorted_;  // the radial distortion of max_radius_
};

}  // namespace microtrace
