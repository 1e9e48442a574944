#pragma once
/// Reads EXT_mesh_gpu_instancing.

#include "io/gltf/bytes/accessors.hpp"
#include "io/gltf/document/asset.hpp"

#include <microtrace/math.hpp>

#include <cstddef>
#include <unordered_map>
#include <vector>

#include <glm/vec4.hpp>

namespace microtrace::io::gltf {

/// The maximum number of instances of all nodes together.
inline constexpr std::size_t kMaxInstances = std::size_t{1} << 22;

/// The transforms from the instances of a node's mesh to the node. Empty arrays stand for
/// attributes that the node lacks.
struct InstanceTransforms {
  std::size_t count = 0;
  std::vector<Vec3> translations{};
  std::vector<glm::vec4> rotations{};  ///< quaternions (x, y, z, w) of any length
  std::vector<Vec3> scales{};

  [[nodiscard]] std::size_t size() const { return count; }
  [[nodiscard]] DMat4 operator[](std::size_t instance) const;
};

class Instances {
 public:
  /// Throws Error: invalid_scene, limit.
  Instances(Asset& asset, const Model& model, AccessorReader& reader);

  /// Null for a node without instancing.
  [[nodiscard]] const InstanceTransforms* of(std::size_t node) const;

 private:
  std::unordered_map<std::size_t, InstanceTransforms> node_from_instance_;  // by node index
};

}  // namespace microtrace::io::gltf
