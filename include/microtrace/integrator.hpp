#pragma once
/// The extension point of the renderer: an Integrator computes the colors of camera rays.

#include <microtrace/bvh.hpp>
#include <microtrace/camera.hpp>
#include <microtrace/export.hpp>
#include <microtrace/film.hpp>
#include <microtrace/frustum.hpp>
#include <microtrace/math.hpp>
#include <microtrace/ray.hpp>
#include <microtrace/scene.hpp>
#include <microtrace/surface_interaction.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace microtrace {

struct BitPage;
class Lighting;
class PathGuide;
class Shading;
class Surfaces;

/// The scene as integrators see it. Rays, points and normals are in scene coordinates, whose origin
/// is at Scene::origin in world space. For Monte Carlo integrators the scene may be translated, so
/// that its origin is near the camera.
struct MICROTRACE_EXPORT World {
  const Scene& scene;
  const Bvh& bvh;
  const RayGenerator& camera;
  std::uint32_t seed = 0;     ///< random seed
  std::uint32_t samples = 1;  ///< samples per pixel for which base_color() filters textures
  const Surfaces& surfaces;   ///< this and the following are for the library's integrators
  const Shading* shading = nullptr;
  const Lighting* lighting = nullptr;
  const PathGuide* guide = nullptr;  ///< null if paths are not guided
  /// Triangles whose backs have no coverage for camera rays, or null for none. It may leave out
  /// some of them.
  const BitPage* const* open_backs = nullptr;

  /// Returns position, normals, texture coordinates, object and triangle at a hit of `ray`.
  [[nodiscard]] SurfaceInteraction surface(const Ray& ray, const Hit& hit) const {
    return interact(bvh.primitives(), ray, hit);
  }

  /// Returns the base color at a hit of a camera ray in linear Rec. 709: the product of factor,
  /// texture and vertex color. The texture is filtered over one sample's part of the pixel. Alpha
  /// is the surface's coverage: 0 on the back of a one-sided surface and where a mask removes the
  /// surface, 1 where the surface is opaque (glTF 2.0, sections 3.9.4 and 3.9.6).
  [[nodiscard]] Vec4 base_color(const Ray& ray, const Hit& hit) const;

  /// Returns the first hit of a camera ray with coverage above 0, starting with `hit` itself.
  [[nodiscard]] std::optional<Hit> first_visible(const Ray& ray, std::optional<Hit> hit) const;
};

/// Identifies a sample of a picture. Together with the seed it determines all random numbers.
struct SampleId {
  std::uint32_t x = 0, y = 0;  ///< pixel in the whole picture
  std::uint32_t index = 0;     ///< index within the pixel, from 0
  std::uint32_t key = 0;       ///< hash of the random seed and the pixel
};

/// The radiance along one ray, without the scene's background.
struct Sample {
  Vec3 color{0};    ///< radiance, linear Rec. 709, premultiplied with alpha
  float alpha = 0;  ///< opacity in front of the background: 0 transparent, 1 opaque
};

/// Numbers of rays by purpose, and the processor time spent on them in seconds, summed over
/// threads.
struct MICROTRACE_EXPORT RayCounts {
  struct Kind {
    std::uint64_t rays = 0;
    double seconds = 0;
  };
  Kind camera{};
  Kind path{};    ///< from surfaces to continue paths
  Kind shadow{};  ///< from surfaces to lights; the seconds include the evaluation of the surfaces
                  ///< that these rays hit
  std::uint64_t beyond = 0;  ///< calls of Bvh::next to continue behind surfaces that let paths or
                             ///< light through

  RayCounts& operator+=(const RayCounts& other);
};

/// The maximum number of rays per call of an integrator: kRandomBatch for Monte Carlo integrators,
/// kRegularBatch for others.
inline constexpr std::size_t kRandomBatch = 1024, kRegularBatch = 64;

class MICROTRACE_EXPORT Integrator {
 public:
  virtual ~Integrator() = default;

  /// Sets samples[i] to the result for rays[i] with ids[i]. All spans have the same size, at most
  /// kRegularBatch, or kRandomBatch if is_random(). Consecutive rays are neighbors in the picture,
  /// so Bvh::intersect can trace them as packets. Each result must depend only on its own ray and
  /// id. Several threads call this function at the same time.
  virtual void trace(const World& world, std::span<const Ray> rays, std::span<const SampleId> ids,
                     std::span<Sample> samples) const = 0;

  /// Returns the sample that trace() would return for every ray in the frustum, if it is certain
  /// that all are equal and this can be found without tracing each ray. Called for rectangles of
  /// the film before their rays are made.
  [[nodiscard]] virtual std::optional<Sample> common_sample(const World& /*world*/,
                                                            const Frustum& /*frustum*/) const {
    return std::nullopt;
  }

  /// Returns true if the samples are arbitrary data instead of radiance. Data is neither filtered
  /// nor composited over the background.
  [[nodiscard]] virtual bool is_data() const { return false; }

  /// Returns true for Monte Carlo integrators. Their pixel positions are jittered, and their
  /// batches hold up to kRandomBatch rays.
  [[nodiscard]] virtual bool is_random() const { return false; }

  /// Returns the counts of all calls of trace() so far; zero if rays are not counted. The numbers
  /// of rays depend only on the pictures, but the seconds vary.
  [[nodiscard]] virtual RayCounts ray_counts() const { return {}; }

  /// Returns how 8-bit formats should show the finished film.
  [[nodiscard]] virtual Display display(const Film& /*film*/) const { return {}; }

 protected:
  Integrator() = default;
  Integrator(const Integrator&) = default;
  Integrator& operator=(const Integrator&) = default;
};

/// Shows base colors without lighting: the first opaque surface, blended with transparent surfaces
/// in front of it.
class MICROTRACE_EXPORT FlatIntegrator final : public Integrator {
 public:
  void trace(const World& world, std::span<const Ray> rays, std::span<const SampleId> ids,
             std::span<Sample> samples) const override;
  [[nodiscard]] std::optional<Sample> common_sample(const World& world,
                                                    const Frustum& frustum) const override;
};

}  // namespace microtrace
