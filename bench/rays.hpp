#pragma once
/// Generates the rays of ray-casting benchmarks. They are the same on every machine, except for
/// differences between C libraries' sines and cosines.

#include <microtrace/camera.hpp>
#include <microtrace/hit.hpp>
#include <microtrace/primitives.hpp>
#include <microtrace/ray.hpp>
#include <microtrace/scene.hpp>

#include <optional>
#include <span>
#include <vector>

namespace microtrace::bench {

/// Rays are ordered tile by tile, and row by row within a tile.
inline constexpr std::uint32_t kTileEdge = 8;
inline constexpr std::size_t kTileRays = std::size_t{kTileEdge} * kTileEdge;

/// Rays, and the hit of each ray; nothing for misses.
struct Traced {
  std::span<const Ray> rays;
  std::span<const std::optional<Hit>> hits;
};

/// Returns a pseudorandom point, uniformly distributed on the unit sphere. It depends only on seed
/// and counter.
[[nodiscard]] DVec3 random_point(std::uint64_t seed, std::uint64_t counter);

/// Returns the length of the diagonal of the bounding box of a scene's meshes, in world units.
[[nodiscard]] double extent(const Scene& scene);

/// Returns one ray through the center of each pixel, tile by tile. Width and height are multiples
/// of kTileEdge.
[[nodiscard]] std::vector<Ray> primary_rays(const Camera& camera, ImageSize size);

/// Returns one ray for each hit, which starts at the hit point, in the order of the hits.
/// Directions are cosine-distributed about the geometric normal on the side of the incoming ray.
/// Origins are 1e-5 times the extent above the surface, so that rounding in either program never
/// puts an origin on the wrong side. Triangles without area emit no rays.
[[nodiscard]] std::vector<Ray> cosine_rays(const Primitives& primitives, const Traced& traced,
                                           double extent, float t_max, std::uint64_t seed);

/// Shuffles the rays by a fixed permutation, so that neighboring rays are incoherent.
void shuffle(std::span<Ray> rays, std::uint64_t seed);

/// Every `step`-th run of `length` rays. This sample is as coherent as all rays.
[[nodiscard]] std::vector<Ray> sample(std::span<const Ray> rays, std::size_t length,
                                      std::size_t step);

}  // namespace microtrace::bench
