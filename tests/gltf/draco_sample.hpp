#pragma once
/// A mesh as Draco's own library encodes and decodes it. In a module of its own: the library holds
/// another tinygltf than ours, and the two must not meet in one program.

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

inline constexpr std::uint32_t draco_rows = 9, draco_columns = 30;  // of vertices

/// Makes a bowl of 14 bits with normals and colours (2 i, 7, 255, 255), sequential or by
/// edgebreaker.
using MakeDracoSample = void (*)(bool sequential, DracoSample& sample);

}  // namespace microtrace::tests
