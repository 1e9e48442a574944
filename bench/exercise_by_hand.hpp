#pragma once
/// A ray tracer for the example scenes as one writes it by hand: the usual formulas in float32, one
/// ray and one primitive at a time. The peer for pictures of simple scenes. It shares no code with
/// microtrace, because it is compiled with -march=native and -ffast-math.

#include <cstdint>
#include <vector>

namespace by_hand {

struct Camera {
  float position[3], direction[3], up[3];
  float vertical_fov;  ///< degrees
};

/// Renders the scene of scenes/perspective1.json to 8-bit RGB.
std::vector<std::uint8_t> render(const Camera& camera, int width, int height);

}  // namespace by_hand
