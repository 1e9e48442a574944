#pragma once
/// What a camera ray brings back. This is the open seam of the renderer: whatever answers rays is
/// an Integrator.

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

/// The scene as integrators see it. Rays, points and normals are in the scene's own coordinates,
/// whose origin is at Scene::origin in the world; for integrators that are random they may have
/// another origin, next to the camera.
struct MICROTRACE_EXPORT World {
  const Scene& scene;
  const Bvh& bvh;
  const RayGenerator& camera;
  std::uint32_t seed = 0;     ///< random seed
  std::uint32_t samples = 1;  ///< samples per pixel for which base_color filters textures
  const Surfaces& surfaces;   ///< for the integrators of the library, as the next two
  const Shading* shading = nullptr;
  const Lighting* lighting = nullptr;

  /// Position, normals, texture coordinates, object and triangle at a hit of `ray`.
  [[nodiscard]] SurfaceInteraction surface(const Ray& ray, const Hit& hit) const {
    return interact(bvh.primitives(), ray, hit);
  }

  /// Base color at a hit of a camera ray, linear Rec. 709: factor, texture and vertex color, the
  /// texture filtered over the sample's part of the pixel. Alpha is the surface's coverage: 0 for
  /// the back of a one-sided surface and where a mask cuts it out, 1 where it is opaque (glTF 2.0,
  /// sections 3.9.4 and 3.9.6).
  [[nodiscard]] Vec4 base_color(const Ray& ray, const Hit& hit) const;

  /// The first hit of a camera ray, from `hit` on, where coverage is above 0.
  [[nodiscard]] std::optional<Hit> first_visible(const Ray& ray, std::optional<Hit> hit) const;
};

/// Which of a picture's samples a ray is. With the seed it settles all that is random about it.
struct SampleId {
  std::uint32_t x = 0, y = 0;  ///< pixel of the whole picture
  std::uint32_t index = 0;     ///< in the pixel, from 0
  std::uint32_t key = 0;       ///< a random number of seed and pixel
};

/// The light of one ray without the scene's background.
struct Sample {
  Vec3 color{0};    ///< linear Rec. 709, multiplied with alpha
  float alpha = 0;  ///< the part of the background that is hidden: 0 none of it, 1 all
};

/// Rays by what they were for, and the seconds of processor time that they took in all threads.
struct MICROTRACE_EXPORT RayCounts {
  struct Kind {
    std::uint64_t rays = 0;
    double seconds = 0;
  };
  Kind camera{};
  Kind path{};               ///< on from surfaces
  Kind shadow{};             ///< from surfaces to lights; with the seconds of what these meet
  std::uint64_t beyond = 0;  ///< hits behind hits, where surfaces let paths or light through

  RayCounts& operator+=(const RayCounts& other);
};

/// The most rays that an integrator is asked about at once, if its answers are random and if not.
inline constexpr std::size_t kRandomBatch = 1024, kMaxBatch = 64;

class MICROTRACE_EXPORT Integrator {
 public:
  virtual ~Integrator() = default;

  /// samples[i] answers rays[i], which is ids[i]; all have one length, at most kMaxBatch, or
  /// kRandomBatch if is_random(). Runs of rays are neighbours, such that they make bundles for
  /// Bvh::intersect. Each answer depends on its own ray and id alone. Any number of threads call it
  /// at a time.
  virtual void trace(const World& world, std::span<const Ray> rays, std::span<const SampleId> ids,
                     std::span<Sample> samples) const = 0;

  /// Whether the samples are numbers of any kind rather than light: then they are not filtered, and
  /// not put over the background.
  [[nodiscard]] virtual bool is_data() const { return false; }

  /// Whether answers are random: then rays go through random places of their pixels too, and as
  /// many come at a time as can.
  [[nodiscard]] virtual bool is_random() const { return false; }

  /// The rays of all calls of trace() so far; none where they are not counted. The numbers depend
  /// on the picture alone, the seconds do not.
  [[nodiscard]] virtual RayCounts ray_counts() const { return {}; }

  /// How 8-bit formats should show the finished film.
  [[nodiscard]] virtual Display display(const Film& /*film*/) const { return {}; }

 protected:
  Integrator() = default;
  Integrator(const Integrator&) = default;
  Integrator& operator=(const Integrator&) = default;
};

/// The colour of what the ray hits first, without light.
class MICROTRACE_EXPORT FlatIntegrator final : public Integrator {
 public:
  void trace(const World& world, std::span<const Ray> rays, std::span<const SampleId> ids,
             std::span<Sample> samples) const override;
};

}  // namespace microtrace
