#pragma once
/// The requirements of an accessor's users on its elements.

#include "io/gltf/document/asset.hpp"

#include <vector>

namespace microtrace::io::gltf {

struct AccessorUses {
  bool normals = false, tangents = false, colors = false, times = false, matrices = false;
  bool quaternions = false;
  bool spline = false;  ///< quaternions of a cubic spline
};

/// By accessor index.
[[nodiscard]] std::vector<AccessorUses> accessor_uses(const Asset& asset);

}  // namespace microtrace::io::gltf
