#pragma once
/// Renders small path-traced pictures and computes their statistics.

#include <microtrace/path.hpp>
#include <microtrace/render.hpp>

#include <cmath>
#include <cstdint>
#include <vector>

namespace microtrace {

/// Parameters of a path-traced picture.
struct Shot {
  ImageSize size{.width = 16, .height = 16};
  std::uint32_t samples = 16;
  std::uint32_t seed = 0;
  std::uint32_t max_depth = 8;
  Backfaces backfaces = Backfaces::pass;
  unsigned threads = 1;
  bool guiding = false;
};

[[nodiscard]] inline Film shoot(const Scene& scene, const Camera& camera, const Shot& shot) {
  const PathIntegrator path(
      {.max_depth = shot.max_depth, .backfaces = shot.backfaces, .guiding = shot.guiding});
  return render(
      scene, camera, shot.size,
      {.threads = shot.threads, .integrator = &path, .samples = shot.samples, .seed = shot.seed});
}

/// Returns all pixels, row by row.
[[nodiscard]] inline std::vector<DVec3> pixels_of(const Film& film) {
  std::vector<DVec3> result;
  for (std::uint32_t y = 0; y < film.size().height; ++y) {
    for (const Vec3& pixel : film.row(y)) result.emplace_back(pixel);
  }
  return result;
}

/// Returns the mean of all pixels.
[[nodiscard]] inline DVec3 mean_of(const Film& film) {
  DVec3 sum(0);
  const std::vector<DVec3> pixels = pixels_of(film);
  for (const DVec3& pixel : pixels) sum += pixel;
  return sum / static_cast<double>(pixels.size());
}

/// The mean of independent numbers, and the estimated standard deviation of this mean.
struct Estimate {
  double mean = 0, deviation = 0;

  explicit Estimate(const std::vector<double>& numbers) {
    const auto n = static_cast<double>(numbers.size());
    for (const double x : numbers) mean += x / n;
    for (const double x : numbers) deviation += (x - mean) * (x - mean);
    deviation = std::sqrt(deviation / (n - 1) / n);
  }
};

/// Renders `count` pictures with different seeds. Estimates the mean of their green channel.
[[nodiscard]] inline Estimate estimate(const Scene& scene, const Camera& camera, Shot shot,
                                       std::uint32_t count) {
  std::vector<double> means;
  for (std::uint32_t i = 0; i < count; ++i) {
    ++shot.seed;
    means.push_back(mean_of(shoot(scene, camera, shot)).y);
  }
  return Estimate(means);
}

/// Returns a parallelogram. Its front is seen from where the rotation from `along` to `up` is
/// counterclockwise.
[[nodiscard]] inline Mesh parallelogram(const Vec3& corner, const Vec3& along, const Vec3& up) {
  return {.positions = {corner, corner + along, corner + along + up, corner + up},
          .triangles = {{{0, 1, 2}}, {{0, 2, 3}}}};
}

}  // namespace microtrace
