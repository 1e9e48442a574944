#pragma once
/// What those who name an accessor ask of its numbers.

#include "io/gltf/document/asset.hpp"

#include <vector>

namespace microtrace::io::gltf {

struct AccessorUses {
  bool normals = false, tangents = false, colors = false, times = false, matrices = false;
  bool quaternions = false;
  bool spline = false;  ///< the quaternions are a cubic spline's
};

/// By accessor.
[[nodiscard]] std::vector<AccessorUses> accessor_uses(const Asset& asset);

}  // namespace microtrace::io::gltf
