#pragma once
/// EXT_mesh_gpu_instancing.

#include "io/gltf/bytes/accessors.hpp"
#include "io/gltf/document/asset.hpp"

#include <microtrace/math.hpp>

#include <cstddef>
#include <unordered_map>
#include <vector>

namespace microtrace::io::gltf {

/// No asset has more instances in all its nodes.
inline constexpr std::size_t max_instances = std::size_t{1} << 22;

class Instances {
 public:
  /// Throws Error: invalid_scene, limit.
  Instances(Asset& asset, const Model& model, AccessorReader& reader);

  /// The transforms of the instances that a node's mesh has, in the node's space; null where the
  /// node has its mesh once, in its own place.
  [[nodiscard]] const std::vector<DMat4>* of(std::size_t node) const;

 private:
  std::unordered_map<std::size_t, std::vector<DMat4>> node_from_instance_;  // by node
};

}  // namespace microtrace::io::gltf
