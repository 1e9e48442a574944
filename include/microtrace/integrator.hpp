#pragma once
/// The extension point of the renderer: an Integrator computes the color of camera rays.

#include <microtrace/bvh.hpp>
#include <microtrace/camera.hpp>
#include <microtrace/export.hpp>
#include <microtrace/film.hpp>
#include <microtrace/math.hpp>
#include <microtrace/ray.hpp>
#include <microtrace/scene.hpp>
#include <microtrace/surface_interaction.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace microtrace {

class Lighting;
class Shading;
class Surfaces;

/// The scene as integrators see it. Rays, points and normals are in scene coordinates, whose origin
/// is at Scene::origin in world space. Monte Carlo integrators may get another origin near the
/// camera.
struct MICROTRACE_EXPORT World {
  const Scene& scene;
  const Bvh& bvh;
  const RayGenerator& camera;
  std::uint32_t seed = 0;     ///< random seed
  std::uint32_t samples = 1;  ///< samples per pixel for which base_color filters textures
  const Surfaces& surfaces;   ///< this and the next two are for the library's own integrators
  const Shading* shading = nullptr;
  const Lighting* lighting = nullptr;

  /// Position, normals, texture coordinates, object and triangle at a hit of `ray`.
  [[nodiscard]] SurfaceInteraction surface(const Ray& ray, const Hit& hit) const {
    return interact(bvh.primitives(), ray, hit);
  }

  /// Base color at a hit of a camera ray, linear Rec. 709: the product of factor, texture and
  /// vertex color. The texture is filtered over the sample's part of the pixel. Alpha is the
  /// surface's coverage: 0 for the back of a one-sided surface and where a mask cuts it out, 1
  /// where it is opaque (glTF 2.0, sections 3.9.4 and 3.9.6).
  [[nodiscard]] Vec4 base_color(const Ray& ray, const Hit& hit) const;

  /// The first hit of a camera ray, from `hit` on, with coverage above 0.
  [[nodiscard]] std::optional<Hit> first_visible(const Ray& ray, std::optional<Hit> hit) const;
};

/// Identifies a sample of a picture. Together with the seed it determines all random numbers.
struct SampleId {
  std::uint32_t x = 0, y = 0;  ///< pixel in the whole picture
  std::uint32_t index = 0;     ///< index within the pixel, from 0
  std::uint32_t key = 0;       ///< hash of seed and pixel
};

/// The radiance along one ray, without the scene's background.
struct Sample {
  Vec3 color{0};    ///< linear Rec. 709, premultiplied with alpha
  float alpha = 0;  ///< opacity in front of the background: 0 transparent, 1 opaque
};

/// Numbers of rays by purpose, and their processor time in seconds, summed over threads.
struct MICROTRACE_EXPORT RayCounts {
  struct Kind {
    std::uint64_t rays = 0;
    double seconds = 0;
  };
  Kind camera{};
  Kind path{};    ///< from surfaces, to continue paths
  Kind shadow{};  ///< from surfaces to lights; the seconds include evaluation of the surfaces hit
  std::uint64_t beyond = 0;  ///< calls of Bvh::next, for surfaces that transmit paths or light

  RayCounts& operator+=(const RayCounts& other);
};

/// The maximum number of rays per call of an integrator, for Monte Carlo integrators and for
/// others.
inline constexpr std::size_t kRandomBatch = 1024, kMaxBatch = 64;

class MICROTRACE_EXPORT Integrator {
 public:
  virtual ~Integrator() = default;

  /// samples[i] is the result for rays[i] with ids[i]; all spans have the same size, at most
  /// kMaxBatch, or kRandomBatch if is_random(). Consecutive rays are neighbors, so that they form
  /// packets for Bvh::intersect. Each result must depend only on its own ray and id. Many threads
  /// call this function at the same time.
  virtual void trace(const World& world, std::span<const Ray> rays, std::span<const SampleId> ids,
                     std::span<Sample> samples) const = 0;

  /// True if the samples are arbitrary data instead of radiance. Data is not filtered, and not
  /// composited over the background.
  [[nodiscard]] virtual bool is_data() const { return false; }

  /// True for Monte Carlo integrators: pixel positions are jittered and batches hold up to
  /// kRandomBatch rays.
  [[nodiscard]] virtual bool is_random() const { return false; }

  /// The rays of all calls of trace() so far; zero if they are not counted. The numbers depend only
  /// on the picture, but the seconds vary.
  [[nodiscard]] virtual RayCounts ray_counts() const { return {}; }

  /// How 8-bit formats should show the finished film.
  [[nodiscard]] virtual Display display(const Film& /*film*/) const { return {}; }

 protected:
  Integrator() = default;
  Integrator(const Integrator&) = default;
  Integrator& operator=(const Integrator&) = default;
};

/// The color of the first surface, without light.
class MICROTRACE_EXPORT FlatIntegrator final : public Integrator {
 public:
  void trace(const World& world, std::span<const Ray> rays, std::span<const SampleId> ids,
             std::span<Sample> samples) const override;
};

}  // namespace microtrace
