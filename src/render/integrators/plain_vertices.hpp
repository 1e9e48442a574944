#pragma once
/// Vertices of paths on surfaces of the metallic-roughness model without more, as most are: sixteen
/// at a time by the shading kernels.

#include "render/integrators/departures.hpp"
#include "render/integrators/path_state.hpp"
#include "render/kernels/kernel.hpp"
#include "render/lights/lighting.hpp"
#include "render/shading/shading.hpp"

#include <microtrace/hit.hpp>
#include <microtrace/ray.hpp>

#include <array>

namespace microtrace {

/// Of all paths of a step.
[[nodiscard]] ScatterSetup scatter_setup(const WaveStep& step);

class PlainVertices {
 public:
  PlainVertices();

  void begin(const Lighting& lighting);

  /// All of a step are on shading.is_plain(); `path` and `ray` stay until finish().
  void add(const WaveStep& step, const Shading& shading, const Ray& ray, const Hit& hit,
           const ShadingPoint& point, const PathState& path, Departures& departures);
  /// Ends the step.
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
