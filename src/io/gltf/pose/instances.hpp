#pragma once
/// Reads EXT_mesh_gpu_instancing.

#include "io/gltf/bytes/accessors.hpp"
#include "io/gltf/document/asset.hpp"

#include <microtrace/math.hpp>

#include <cstddef>
#include <unordered_map>
#include <utility>
#include <vector>

#include <glm/vec4.hpp>

namespace microtrace::io::gltf {

/// The maximum number of instances of all nodes together.
inline constexpr std::size_t kMaxInstances = std::size_t{1} << 22;

/// The transforms from the instances of a node's mesh to the node.
class InstanceTransforms {
 public:
  /// The attributes of the instances. Empty arrays stand for attributes that the node lacks.
  struct Attributes {
    std::size_t count = 0;
    std::vector<Vec3> translations;
    std::vector<glm::vec4> rotations;  ///< quaternions (x, y, z, w) of any length
    std::vector<Vec3> scales;
  };

  InstanceTransforms() = default;
  explicit InstanceTransforms(Attributes attributes) : attributes_(std::move(attributes)) {}

  [[nodiscard]] std::size_t size() const { return attributes_.count; }
  [[nodiscard]] DMat4 operator[](std::size_t instance) const;

 private:
  Attributes attributes_;
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
