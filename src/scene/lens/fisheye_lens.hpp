#pragma once
#include "scene/lens/lens_differential.hpp"

#include <microtrace/camera.hpp>
#include <microtrace/math.hpp>

#include <optional>

namespace microtrace {

/// Applies and inverts FisheyeDistortion; see Lens.
class FisheyeLens {
 public:
  explicit FisheyeLens(const FisheyeDistortion& k);

  [[nodiscard]] std::optional<DVec3> direction(const DVec2& image) const;
  [[nodiscard]] std::optional<DVec2> image(const DVec3& direction) const;
  [[nodiscard]] LensDifferential differential(const DVec3& d) const;

 private:
  [[nodiscard]] double distorted(double angle) const;
  [[nodiscard]] double slope(double angle) const;

  FisheyeDistortion k_;
  double max_angle_;      // measured from the viewing direction
  double max_distorted_;  // distorted(max_angle_)
};

}  // namespace microtrace
