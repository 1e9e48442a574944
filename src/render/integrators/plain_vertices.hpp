#pragma once
/// Path vertices on metallic-roughness surfaces without further properties, the most common kind:
/// sixteen at a time by the shading kernels.

#include "render/integrators/departures.hpp"
#include "render/integrators/path_state.hpp"
#include "render/kernels/kernel.hpp"
#include "render/lights/lighting.hpp"
#include "render/shading/shading.hpp"

#include <microtrace/hit.hpp>
#include <microtrace/ray.hpp>

#include <array>

namespace microtrace {

/// The parameters of all paths of a bounce.
[[nodiscard]] ScatterSetup scatter_setup(const WaveStep& step);

class PlainVertices {
 public:
  PlainVertices();

  void begin(const Lighting& lighting);

  /// All vertices of a bounce must have shading.is_plain(); `path` and `ray` must remain valid
  /// until finish().
  void add(const WaveStep& step, const Shading& shading, const Ray& ray, const Hit& hit,
           const ShadingPoint& point, const PathState& path, Departures& departures);
  /// Finishes the bounce.
  void finish(const WaveStep& step, Departures& departures);

 private:
  struct Vertex {
    const Ray* ray;
    Hit hit;
    const PathState* path;
    Vec3 p;
    float width;
  };

  void ask_lights(const WaveStep& step);

  const ShadingKernels* kernels_;
  const Lighting* lighting_ = nullptr;
  int count_ = 0;
  std::array<Vertex, kShadingLanes> vertices_{};
  std::array<LightSample, kShadingLanes> lights_{};
  NormalLanes normals_{};
  ScatterLanes scatter_{};
};

}  // namespace microtrace
