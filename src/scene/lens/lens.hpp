#pragma once
/// Applies and inverts lens distortion. Directions and points are in OpenCV's camera space: x
/// right, y down, z forward. Image points are in units of the focal lengths, relative to the
/// principal point. docs/derivations.md has the formulas.

#include "scene/lens/fisheye_lens.hpp"
#include "scene/lens/rational_lens.hpp"

#include <microtrace/camera.hpp>
#include <microtrace/math.hpp>

#include <optional>
#include <variant>

namespace microtrace {

class Lens {
 public:
  explicit Lens(const Distortion& distortion);

  /// The direction that appears at an image point; nothing if no direction does. It is scaled to
  /// depth 1 for rational lenses and to unit length for fisheye lenses.
  [[nodiscard]] std::optional<DVec3> direction(const DVec2& image) const {
    return std::visit([&](const auto& lens) { return lens.direction(image); }, lens_);
  }

  /// The image point of a direction of any length; the inverse of direction().
  [[nodiscard]] std::optional<DVec2> image(const DVec3& direction) const {
    return std::visit([&](const auto& lens) { return lens.image(direction); }, lens_);
  }

  /// The derivatives of the unit direction d with respect to its image point. They are finite even
  /// where the distortion can't be inverted.
  [[nodiscard]] LensDifferential differential(const DVec3& d) const {
    return std::visit([&](const auto& lens) { return lens.differential(d); }, lens_);
  }

 private:
  std::variant<RationalLens, FisheyeLens> lens_;
};

}  // namespace microtrace
