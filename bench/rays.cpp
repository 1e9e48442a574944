#include "rays.hpp"

#include <microtrace/primitives.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>

namespace microtrace::bench {
namespace {

// Applies the output function of SplitMix64 to a counter (Steele, Lea, Flood: Fast splittable
// pseudorandom number generators, 2014).
std::uint64_t random_bits(std::uint64_t seed, std::uint64_t counter) {
  std::uint64_t z = (seed << 40U) + counter * 0x9E3779B97F4A7C15U;
  z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
  z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
  return z ^ (z >> 31U);
}

// Returns a pseudorandom number in [0, 1).
double random(std::uint64_t seed, std::uint64_t counter) {
  return static_cast<double>(random_bits(seed, counter) >> 11U) * 0x1p-53;
}

}  // namespace

DVec3 random_point(std::uint64_t seed, std::uint64_t counter) {
  const double z = 2 * random(seed, 2 * counter) - 1;
  const double angle = 2 * std::numbers::pi * random(seed, 2 * counter + 1);
  const double r = std::sqrt(std::max(0.0, 1 - z * z));
  return {r * std::cos(angle), r * std::sin(angle), z};
}

double extent(const Scene& scene) {
  Vec3 lo{std::numeric_limits<float>::infinity()}, hi = -lo;
  for (const Object& object : scene.objects) {
    const auto& mesh = std::get<Mesh>(object.shape);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
      lo = glm::min(lo, mesh.position(i));
      hi = glm::max(hi, mesh.position(i));
    }
  }
  return glm::length(DVec3(hi) - DVec3(lo));
}

std::vector<Ray> primary_rays(const Camera& camera, ImageSize size) {
  const RayGenerator generate(camera, size);
  std::vector<Ray> rays;
  rays.reserve(std::size_t{size.width} * size.height);
  for (std::uint32_t top = 0; top < size.height; top += kTileEdge) {
    for (std::uint32_t left = 0; left < size.width; left += kTileEdge) {
      for (std::uint32_t i = 0; i < kTileRays; ++i)
        rays.push_back(generate(left + i % kTileEdge + 0.5, top + i / kTileEdge + 0.5));
    }
  }
  return rays;
}

std::vector<Ray> cosine_rays(const Primitives& primitives, const Traced& traced, double extent,
                             float t_max, std::uint64_t seed) {
  std::vector<Ray> rays;
  rays.reserve(traced.rays.size());
  for (std::size_t i = 0; i < traced.rays.size(); ++i) {
    if (!traced.hits[i]) continue;
    const Ray& ray = traced.rays[i];
    const Triangle triangle = *primitives.triangle(traced.hits[i]->id);
    const DVec3 a(triangle.a), d(ray.d);
    DVec3 n = glm::cross(DVec3(triangle.b) - a, DVec3(triangle.c) - a);
    if (n == DVec3(0)) continue;
    n = glm::normalize(glm::dot(n, d) > 0 ? -n : n);
    // The sum of the normal and a point on the unit sphere has a cosine-distributed direction.
    const DVec3 sum = n + random_point(seed, i);
    const double length = glm::length(sum);
    const DVec3 p = DVec3(ray.o) + double{traced.hits[i]->t} * d + 1e-5 * extent * n;
    rays.push_back({.o = Vec3(p), .d = Vec3(length > 1e-6 ? sum / length : n), .t_max = t_max});
  }
  return rays;
}

void shuffle(std::span<Ray> rays, std::uint64_t seed) {
  for (std::size_t i = rays.size(); i > 1; --i)
    std::swap(rays[i - 1], rays[random_bits(seed, i) % i]);
}

std::vector<Ray> sample(std::span<const Ray> rays, std::size_t length, std::size_t step) {
  std::vector<Ray> some;
  for (std::size_t first = 0; first < rays.size(); first += step * length) {
    const auto run = rays.subspan(first, std::min(length, rays.size() - first));
    some.insert(some.end(), run.begin(), run.end());
  }
  return some;
}

}  // namespace microtrace::bench
