#pragma once
/// Reads EXT_mesh_gpu_instancing.

#include "io/gltf/bytes/accessors.hpp"
#include "io/gltf/document/asset.hpp"

#include <microtrace/math.hpp>

#include <cstddef>
#include <unordered_map>
#include <vector>

namespace microtrace::io::gltf {

/// The maximum number of instances of all nodes together.
inline constexpr std::size_t kMaxInstances = std::size_t{1} << 22;

class Instances {
 public:
  /// Throws Error: invalid_scene, limit.
  Instances(Asset& asset, const Model& model, AccessorReader& reader);

  /// The transform from each instance of a node's mesh to the node. Null for a node without
  /// instancing.
  [[nodiscard]] const std::vector<DMat4>* of(std::size_t node) const;

 private:
  std::unordered_map<std::size_t, std::vector<DMat4>> node_from_instance_;  // by node index
};

}  // namespace microtrace::io::gltf
