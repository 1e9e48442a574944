#include "render/integrators/wavefront/medium_event.hpp"

#include "render/bsdf/frame.hpp"
#include "render/media/beer_lambert.hpp"
#include "render/media/free_flight.hpp"
#include "render/media/henyey_greenstein.hpp"
#include "render/sampling/warps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace microtrace {
namespace {

/// Limits footprints in media without an end, so that they stay finite.
constexpr double kLongestFlight = 1e30;

/// Limits the extinction such that flights from p are long enough to move a float32 point: to a
/// mean free path of about 90 spacings of float32 numbers. Light spreads over so short a distance
/// invisibly, so the color of the body remains. Without this limit, paths in denser media would end
/// after kMostScatterings events at the same point.
Medium with_resolvable_flights(const Medium& medium, const Vec3& p) {
  const float greatest = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  Medium result = medium;
  result.extinction = glm::min(medium.extinction, Vec3(0x1p17F / greatest));
  return result;
}

/// Returns true if the path survives Russian roulette, which compensates its throughput. There is
/// no upper limit below 1 as at surfaces: over hundreds of events, the compensation would make the
/// variance infinite.
bool survives(const WaveStep& step, MediumPath& path) {
  if (step.most_survival() == 1) return true;
  const float survival =
      std::min(std::max({path.throughput.x, path.throughput.y, path.throughput.z}), 1.0F);
  if (!(path.sobol.pair(step.pair(sampling::kLobePair)).y < survival)) return false;
  path.throughput /= survival;
  return true;
}

/// The origin of a ray that leaves an event at o + t d. Usually this point is rounded to float32.
/// If a surface is so close that the rounded point may be behind it, the event takes place at the
/// ray's origin instead, which is certainly on the right side. This displaces hardly any events:
/// none of half a million in scenes/gltf/media.glb.
Vec3 origin_of(const Bvh& bvh, const Ray& ray, double t, double t_of_hit) {
  const Vec3 p = Vec3(DVec3(ray.o) + t * DVec3(ray.d)) + Vec3(0.0F);  // without -0
  // t_of_hit is rounded to float32, and the error of t is much smaller.
  const bool is_before_hit = t < t_of_hit * (1 - 0x1p-22);
  return is_before_hit && bvh.is_clear(p) ? p : ray.o;
}

/// Samples the direction after scattering, and its pdf.
struct Direction {
  Vec3 wi;
  float pdf;
};
Direction sample_direction(float anisotropy, const Vec3& d, const Vec2& u) {
  const double cosine = std::clamp(henyey_greenstein_cosine(anisotropy, u.x), -1.0, 1.0);
  const auto sine = static_cast<float>(std::sqrt(1 - cosine * cosine));
  const auto azimuth = sampling::unit_pair<1>(u.y);
  const Vec3 local(sine * azimuth.cosine, sine * azimuth.sine, static_cast<float>(cosine));
  return {.wi = bsdf::Frame<1>::about(d).to_world(local),
          .pdf = static_cast<float>(henyey_greenstein_pdf(anisotropy, cosine))};
}

}  // namespace

MediumEvent cross_medium(const Bvh& bvh, const WaveStep& step, const Ray& ray,
                         const std::optional<Hit>& hit, float distance, const Medium& medium,
                         MediumPath& path) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (!medium.scatters()) {
    // A medium that only absorbs and has no end is treated as a vacuum.
    if (hit) path.throughput *= beer_lambert(medium.extinction, distance);
    return {};
  }
  if (path.throughput == Vec3(0)) return {.arrives = false};
  const FreeFlight flight =
      sample_free_flight(with_resolvable_flights(medium, ray.o), path.throughput,
                         hit ? distance : kInfinity, path.sobol.pair(step.flight_pair()));
  path.throughput *= flight.weight;
  if (!flight.distance) return {};
  if (++path.scatterings > kMostScatterings || !survives(step, path)) return {.arrives = false};

  const double length = std::sqrt(glm::dot(DVec3(ray.d), DVec3(ray.d)));
  const auto [wi, pdf] = sample_direction(medium.anisotropy, unit<1>(ray.d),
                                          path.sobol.pair(step.pair(sampling::kDirectionPair)));
  path.begin += path.spread * static_cast<float>(std::min(*flight.distance, kLongestFlight));
  // The spread doesn't accumulate over hundreds of events, or it would exceed the distances that
  // light diffuses. Few events forget all earlier directions.
  path.spread = std::max(path.spread, step.spread(pdf));
  path.pdf = pdf;
  return {.arrives = false,
          .distance = *flight.distance,
          .scattered = Ray{
              .o = origin_of(bvh, ray, *flight.distance / length, hit ? double{hit->t} : kInfinity),
              .t_min = 0,
              .d = wi}};
}

}  // namespace microtrace
