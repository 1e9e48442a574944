#pragma once
/// What a camera ray brings back. This is the open seam of the renderer: whatever answers rays is
/// an Integrator.

#include <microtrace/bvh.hpp>
#include <microtrace/camera.hpp>
#include <microtrace/film.hpp>
#include <microtrace/math.hpp>
#include <microtrace/ray.hpp>
#include <microtrace/scene.hpp>

#include <cstddef>
#include <span>

namespace microtrace {

class Surfaces;

/// What integrators ask.
struct World {
  const Scene& scene;
  const Bvh& bvh;            ///< of that scene
  const Surfaces& surfaces;  ///< of that scene: src/render/surfaces.hpp
  const RayGenerator& camera;
};

/// The light of one ray without the scene's background.
struct Sample {
  Vec3 color{0};    ///< linear Rec. 709, multiplied with alpha
  float alpha = 0;  ///< the part of the background that is hidden: 0 none of it, 1 all
};

/// The most rays that an integrator is asked about at once.
inline constexpr std::size_t kMaxBatch = 64;

class Integrator {
 public:
  virtual ~Integrator() = default;

  /// samples[i] answers rays[i]; both have one length, at most kMaxBatch. The rays are neighbours:
  /// they make one bundle for Bvh::intersect. Each answer depends on its own ray alone. Any number
  /// of threads call it at a time.
  virtual void trace(const World& world, std::span<const Ray> rays,
                     std::span<Sample> samples) const = 0;

  /// Whether the samples are numbers of any kind rather than light: then they are not filtered, and
  /// not put over the background.
  [[nodiscard]] virtual bool is_data() const { return false; }

  /// How 8-bit formats should show the finished film.
  [[nodiscard]] virtual Display display(const Film& /*film*/) const { return {}; }

 protected:
  Integrator() = default;
  Integrator(const Integrator&) = default;
  Integrator& operator=(const Integrator&) = default;
};

/// The colour of what the ray hits first, without light.
class FlatIntegrator final : public Integrator {
 public:
  void trace(const World& world, std::span<const Ray> rays,
             std::span<Sample> samples) const override;
};

}  // namespace microtrace
