#pragma once
/// The rays that ray-casting benchmarks ask about. The same on every machine, up to the C library's
/// sine and cosine.

#include <microtrace/camera.hpp>
#include <microtrace/hit.hpp>
#include <microtrace/ray.hpp>
#include <microtrace/shape.hpp>

#include <optional>
#include <span>
#include <vector>

namespace microtrace::bench {

/// Rays of one tile of pixels follow each other in the order of its rows.
inline constexpr std::uint32_t kTileEdge = 8;
inline constexpr std::size_t kTileRays = std::size_t{kTileEdge} * kTileEdge;

/// A hit for each ray, nothing where it misses.
struct Traced {
  std::span<const Ray> rays;
  std::span<const std::optional<Hit>> hits;
};

/// Uniform on the unit sphere; another for each seed and counter.
[[nodiscard]] DVec3 random_point(std::uint64_t seed, std::uint64_t counter);

/// The diagonal of the mesh's bounding box, world units.
[[nodiscard]] double extent(const Mesh& mesh);

/// One ray through the center of each pixel, tile by tile. Width and height are multiples of
/// kTileEdge.
[[nodiscard]] std::vector<Ray> primary_rays(const Camera& camera, ImageSize size);

/// From each hit one ray with a cosine-distributed direction about the geometric normal on the side
/// the hit was seen from, in the order of the hits. Origins lie 1e-5 of the extent above the
/// surface, so that rounding in either program puts none of them on its wrong side. Hits are by the
/// index of a triangle in the mesh; triangles without area send none.
[[nodiscard]] std::vector<Ray> cosine_rays(const Mesh& mesh, const Traced& traced, double extent,
                                           float t_max, std::uint64_t seed);

/// A fixed permutation: neighbors have nothing in common afterwards.
void shuffle(std::span<Ray> rays, std::uint64_t seed);

/// Every `step`-th run of `length` rays: a sample with the coherence of the whole.
[[nodiscard]] std::vector<Ray> sample(std::span<const Ray> rays, std::size_t length,
                                      std::size_t step);

}  // namespace microtrace::bench
