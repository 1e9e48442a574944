#pragma once
/// A mesh encoded and decoded by Draco's own library. It is in a separate module, because that
/// library contains another tinygltf, and the two must not be linked into one program.

#include <microtrace/math.hpp>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace microtrace::tests {

struct DracoSample {
  std::string bytes;
  std::uint32_t position_id = 0, normal_id = 0, color_id = 0;
  std::vector<Vec3> positions, normals;  // as decoded, by point
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

inline constexpr std::uint32_t kDracoRows = 9, kDracoColumns = 30;  // of vertices

/// Creates a bowl with 14 bits, normals and the colors (2 i, 7, 255, 255), with sequential or
/// edgebreaker encoding.
using MakeDracoSample = void (*)(bool sequential, DracoSample& sample);

}  // namespace microtrace::tests
