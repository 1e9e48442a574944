#pragma once
/// Converts nodes to the objects of a scene.

#include "io/gltf/document/asset.hpp"
#include "io/gltf/document/model.hpp"
#include "io/gltf/mesh/surfaces.hpp"
#include "io/gltf/pose/instances.hpp"
#include "io/gltf/pose/nodes.hpp"
#include "io/gltf/pose/posing.hpp"
#include "io/gltf/scene/unique_names.hpp"

#include <microtrace/io.hpp>
#include <microtrace/scene.hpp>

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace microtrace::io::gltf {

class ObjectMaker {
 public:
  struct Sharing {
    Instancing instancing;
    std::size_t copies;  ///< number of times that the nodes are drawn
  };

  /// The arguments must outlive this object.
  ObjectMaker(Asset& asset, const Model& model, const NodeTree& tree,
              const std::vector<std::vector<Surface>>& surfaces, const Instances& instances,
              Poser& poser, const Sharing& sharing)
      : asset_(asset),
        model_(model),
        tree_(tree),
        surfaces_(surfaces),
        instances_(instances),
        poser_(poser),
        sharing_(sharing),
        uses_(surfaces.size()) {}

  /// Chooses the meshes that objects share, and counts the memory of all objects before any is
  /// allocated. Throws Error (limit) if there are too many instances.
  void make_room(const std::vector<PlacedNode>& nodes);

  /// Adds an object for each surface of the node's mesh, if the node has a mesh and is numbered.
  /// The objects of a hidden node have no triangles.
  void add_mesh(const PlacedNode& placed);

  /// True if any node with a surface was visible.
  [[nodiscard]] bool draws_something() const { return draws_something_; }

  /// Returns the objects, which have unique names.
  [[nodiscard]] Objects take() {
    make_unique(
        objects_.size(), [&](std::size_t i) { return objects_.name(i).str(); },
        [&](std::size_t i, const std::string& name) { objects_[i].name = name; });
    return std::move(objects_);
  }

 private:
  /// Calls f(placed node, number of its instances) for each numbered node with a mesh.
  template <class F>
  void for_each_numbered(const std::vector<PlacedNode>& nodes, const F& f) const;
  void choose_shared(const std::vector<PlacedNode>& nodes);
  /// True if the objects of a surface share its arrays.
  [[nodiscard]] bool is_shared(std::size_t node, const Surface& surface) const;

  /// The surface of a node whose instances are a run, or null.
  [[nodiscard]] const Surface* surface_of_run(const PlacedNode& placed) const;
  /// Adds the instances of a node with this surface.
  void add_run(const PlacedNode& placed, const Surface& surface, const ObjectName& name);
  /// Warns if a mesh has vertices that are not finite.
  void check(std::size_t mesh, const Surface& surface, bool is_finite);
  /// `own` are the names of the node's surfaces.
  void add_mesh(std::size_t node, const DMat4& world_from_mesh, const std::vector<ObjectName>& own,
                std::uint32_t instance);
  /// Adds the objects of a node that is not visible.
  void add_hidden(std::size_t node, const std::vector<ObjectName>& own,
                  const InstanceTransforms* instances);
  [[nodiscard]] std::shared_ptr<const Placement> placed(const DMat4& world_from_mesh);
  [[nodiscard]] Mesh posed(std::size_t node, const Surface& surface, const DMat4& world_from_mesh);
  [[nodiscard]] Element primitive(std::size_t mesh, const Surface& surface) const;
  /// Returns the names of the objects of a node, one for each surface. They are numbered if the
  /// node has instances.
  [[nodiscard]] std::vector<ObjectName> names(std::size_t node, bool has_instances) const;

  Asset& asset_;
  const Model& model_;
  const NodeTree& tree_;
  const std::vector<std::vector<Surface>>& surfaces_;
  const Instances& instances_;
  Poser& poser_;
  Sharing sharing_;
  std::vector<std::size_t> uses_;  // number of times that each mesh is drawn
  Objects objects_;
  bool draws_something_ = false;
  std::shared_ptr<std::vector<Placement>> placements_;  // the latest block
};

}  // namespace microtrace::io::gltf
