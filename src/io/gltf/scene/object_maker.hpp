#pragma once
/// Converts nodes to the objects of a scene.

#include "io/gltf/document/asset.hpp"
#include "io/gltf/document/model.hpp"
#include "io/gltf/mesh/surfaces.hpp"
#include "io/gltf/pose/instances.hpp"
#include "io/gltf/pose/nodes.hpp"
#include "io/gltf/pose/posing.hpp"

#include <microtrace/scene.hpp>

#include <string>
#include <utility>
#include <vector>

namespace microtrace::io::gltf {

class ObjectMaker {
 public:
  /// The arguments must outlive this object.
  ObjectMaker(Asset& asset, const Model& model, const NodeTree& tree,
              const std::vector<std::vector<Surface>>& surfaces, const Instances& instances,
              Poser& poser)
      : asset_(asset),
        model_(model),
        tree_(tree),
        surfaces_(surfaces),
        instances_(instances),
        poser_(poser) {}

  /// Counts the memory of all objects before any is allocated. Throws Error (limit) if there are
  /// too many instances.
  void make_room(const std::vector<PlacedNode>& nodes);

  /// Adds an object for each surface of the node's mesh, if the node has a mesh and is visible.
  void add_mesh(const PlacedNode& placed);

  [[nodiscard]] std::vector<Object> take() { return std::move(objects_); }

 private:
  void add_mesh(std::size_t node, const DMat4& world_from_mesh, const std::string& path);
  [[nodiscard]] Mesh posed(std::size_t node, const Surface& surface, const DMat4& world_from_mesh);
  [[nodiscard]] Element primitive(std::size_t mesh, const Surface& surface) const;
  [[nodiscard]] std::string name(const std::string& path, std::size_t mesh,
                                 const Surface& surface) const;

  Asset& asset_;
  const Model& model_;
  const NodeTree& tree_;
  const std::vector<std::vector<Surface>>& surfaces_;
  const Instances& instances_;
  Poser& poser_;
  std::vector<Object> objects_;
  UniqueNames names_;
};

}  // namespace microtrace::io::gltf
