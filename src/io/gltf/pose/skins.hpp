#pragma once
/// Reads skins, whose joints move vertices (glTF 2.0, section 3.7.3).

#include "io/gltf/bytes/accessors.hpp"
#include "io/gltf/document/asset.hpp"
#include "io/gltf/document/model.hpp"
#include "io/gltf/mesh/surfaces.hpp"

#include <microtrace/math.hpp>

#include <cstddef>
#include <optional>
#include <unordered_map>
#include <vector>

#include <glm/vec4.hpp>

namespace microtrace::io::gltf {

/// The joints and weights of each vertex of a surface.
class JointBlend {
 public:
  /// Returns the weighted mean of the matrices of the vertex's joints, in float64.
  [[nodiscard]] DMat4 world_from_mesh(std::size_t vertex) const;

 private:
  friend class Skins;
  struct Influences {
    std::vector<glm::uvec4> joints;  // by vertex; each is less than the number of matrices
    std::vector<glm::vec4> weights;
  };
  const std::vector<DMat4>* world_from_mesh_ = nullptr;  // by joint
  std::vector<Influences> sets_;
};

/// The skins of an asset in one pose.
class Skins {
 public:
  /// `world_from_node` has the transforms of all nodes, including those outside the scene. The
  /// arguments must outlive the skins.
  Skins(Asset& asset, const Model& model, AccessorReader& reader,
        const std::vector<DMat4>& world_from_node)
      : asset_(asset), model_(model), reader_(reader), world_from_node_(world_from_node) {}

  /// Reads the joints and weights of a surface. Returns nothing if the skin has no joints or the
  /// primitive has no JOINTS_0. In these cases, the node's transform determines the surface's
  /// position. Scales weights that don't sum to 1, with a warning. Vertices without weights follow
  /// their first joint. Throws Error (invalid_scene) for a joint missing from the skin.
  [[nodiscard]] std::optional<JointBlend> blend(std::size_t skin, std::size_t mesh,
                                                const Surface& surface);

  /// Returns the transforms of a mesh by each of the skin's joints.
  const std::vector<DMat4>& matrices(std::size_t skin);

 private:
  void check_weights(const Element& attributes, JointBlend& blend);

  Asset& asset_;
  const Model& model_;
  AccessorReader& reader_;
  const std::vector<DMat4>& world_from_node_;
  std::unordered_map<std::size_t, std::vector<DMat4>> matrices_;  // by skin
};

}  // namespace microtrace::io::gltf
