#pragma once
/// A mesh that was encoded and decoded by Google's Draco library. The code is in a separate module,
/// because the Draco library contains its own copy of tinygltf, which must not be linked into one
/// program with the other copy.

#include <microtrace/math.hpp>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace microtrace::tests {

struct DracoSample {
  std::string bytes;
  std::uint32_t position_id = 0, normal_id = 0, color_id = 0;
  std::vector<Vec3> positions, normals;  // decoded values, by point index
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

inline constexpr std::uint32_t kDracoRows = 9, kDracoColumns = 30;  // number of vertices

/// Makes a bowl with positions of 14 bits, normals and the colors (2 i, 7, 255, 255). The encoding
/// is sequential or edgebreaker.
using MakeDracoSample = void (*)(bool sequential, DracoSample& sample);

}  // namespace microtrace::tests
