#pragma once
/// Computes what denoisers need to know of the surfaces that a picture shows.

#include "render/bsdf/parameters.hpp"
#include "render/media/nested_media.hpp"
#include "render/shading/points/footprint.hpp"
#include "render/shading/shading.hpp"

#include <microtrace/bvh.hpp>
#include <microtrace/hit.hpp>
#include <microtrace/integrator.hpp>
#include <microtrace/math.hpp>
#include <microtrace/ray.hpp>

#include <array>
#include <cstddef>
#include <optional>
#include <span>

namespace microtrace {

/// The features of a camera ray, without noise: no random numbers are used.
struct DenoiseFeatures {
  Vec3 albedo{0};  ///< color, each component in [0, 1]
  Vec3 normal{0};  ///< in scene coordinates, facing the viewer; at most of unit length
};

/// Follows camera rays through mirrors and smooth glass to the surfaces that are seen in them, as
/// the documentation of Open Image Denoise recommends. At the first surface that both reflects and
/// transmits, it follows both rays, and weighs what they see by Fresnel's equations. At further
/// ones it follows the stronger ray.
class FeatureTracer {
 public:
  /// The world must outlive this object and have `shading` and `lighting`.
  explicit FeatureTracer(const World& world) : world_(world) {}

  /// Sets features[i] to those of the camera ray rays[i]. Both spans have the same size, at most
  /// kRegularBatch.
  void trace(std::span<const Ray> rays, std::span<DenoiseFeatures> features);

 private:
  static constexpr std::size_t kMostPaths = 2 * kRegularBatch;  ///< each ray is split once at most

  /// A part of a camera ray's light that comes along one way.
  struct Path {
    std::size_t slot = 0;                ///< index of the camera ray
    float share = 1;                     ///< of the camera ray, by which features are weighed
    Vec3 tint{1};                        ///< the color of the surfaces and media on the way
    const NestedMedia* media = nullptr;  ///< the current media
    Vec3 n{0};                           ///< normal of the last surface
    Footprint footprint{};
    bool may_split = true;
  };
  /// A path's vertex on a surface.
  struct Vertex {
    const Ray& ray;
    const Hit& hit;
    const ShadingPoint& point;
    const bsdf::Parameters& parameters;
    const bsdf::Layers& layers;
    Vec3 n;                     ///< shading normal on the ray's side
    const NestedMedia* beyond;  ///< the media on the other side
  };

  /// Follows path i, whose ray hits something, to its next surface that is not transparent.
  void step(std::size_t i, Hit hit);
  void escape(const Ray& ray, const Path& path);
  /// Follows the path through its medium. Adds the features of light that the medium scatters.
  void cross_medium(float distance, Path& path);
  /// Adds the features of the surface, where the path ends.
  void end(const Vertex& vertex, const Path& path);
  /// Continues the path on the rays that a smooth surface reflects and transmits.
  void scatter(const Vertex& vertex, const Path& path);
  void add_ray(const Vertex& vertex, const Path& path, const Vec3& direction);
  /// Makes the rays that were added the current ones.
  void advance();

  const World& world_;
  std::span<DenoiseFeatures> features_{};
  std::size_t depth_ = 0, count_ = 0, next_count_ = 0;
  std::array<Ray, kMostPaths> rays_;
  std::array<PrimitiveId, kMostPaths> left_;  // the primitives that the rays leave
  std::array<Path, kMostPaths> paths_, next_paths_;
  std::array<Bvh::Spawn, kMostPaths> spawns_;
  std::optional<BsdfInput> varying_;
  NestedMediaTable media_;
};

}  // namespace microtrace
