#pragma once
/// The requirements on an accessor's elements that follow from its uses.

#include "io/gltf/document/asset.hpp"

#include <vector>

namespace microtrace::io::gltf {

struct AccessorUses {
  bool normals = false, tangents = false, colors = false, times = false, matrices = false;
  bool quaternions = false;
  bool spline = false;  ///< true if the quaternions belong to a cubic spline
};

/// Returns the uses of each accessor, by accessor index.
[[nodiscard]] std::vector<AccessorUses> accessor_uses(const Asset& asset);

}  // namespace microtrace::io::gltf
