#include "render/media/free_flight.hpp"

#include "scene/math/exponential.hpp"

#include <algorithm>
#include <limits>

#include <glm/geometric.hpp>

namespace microtrace {
namespace {

/// Selects a channel from a random number in [0, 1).
int channel_of(const DVec3& probabilities, double u) {
  if (u < probabilities.x) return 0;
  return u < probabilities.x + probabilities.y ? 1 : 2;
}

/// The transmittance after a distance, which may be infinite.
double transmittance(float extinction, double distance) {
  return extinction > 0 ? power_of_two(-std::min(extinction * distance, 1000.0)) : 1;
}

}  // namespace

FreeFlight sample_free_flight(const Medium& medium, const Vec3& throughput, double end,
                              const Vec2& u) {
  const DVec3 left(throughput), probabilities = left / (left.x + left.y + left.z);
  const double extinction = medium.extinction[channel_of(probabilities, u.y)];
  const double distance = extinction > 0 ? -binary_logarithm(1 - double{u.x}) / extinction
                                         : std::numeric_limits<double>::infinity();
  const bool is_scattered = distance < end;
  // The pdf of each channel for this result, and its contribution.
  DVec3 pdf(0), value(0);
  for (int c = 0; c < 3; ++c) {
    pdf[c] = transmittance(medium.extinction[c], is_scattered ? distance : end) *
             (is_scattered ? medium.extinction[c] : 1);
    value[c] = pdf[c] * (is_scattered ? medium.albedo[c] : 1);
  }
  FreeFlight flight{.weight = Vec3(value / glm::dot(probabilities, pdf))};
  if (is_scattered) flight.distance = distance;
  return flight;
}

}  // namespace microtrace
