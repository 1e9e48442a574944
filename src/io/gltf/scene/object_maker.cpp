#include "io/gltf/scene/object_maker.hpp"

#include "base/memory_account.hpp"
#include "scene/mesh/mesh_memory.hpp"
#include "scene/support.hpp"

#include <algorithm>

namespace microtrace::io::gltf {
namespace {

/// True if all vertices of a shared surface are finite in the world.
bool is_finite(const Surface& surface, const Placement& placement) {
  // Rounded sums are monotonic, so vertices are between the images of the box's corners.
  return std::ranges::all_of(corners_of(surface.box), [&](const DVec3& corner) {
    return microtrace::is_finite(Vec3(placement.point(corner)));
  });
}

bool is_finite(const Mesh& mesh) {
  return std::ranges::all_of(mesh.positions,
                             [](const Vec3& p) { return microtrace::is_finite(p); });
}

/// In automatic mode, meshes are shared if copies would have more triangles than this. With fewer,
/// copies need less than about 150 MB, and rays through copies take less time.
constexpr std::size_t kMostCopied = std::size_t{1} << 20;

/// The size of an object of a run: its placement, and the hash of its name.
constexpr std::size_t kBytesOfInstance = sizeof(Placement) + sizeof(std::size_t);
/// The size of another object, with its placement and the hash of its name.
constexpr std::size_t kBytesOfObject = sizeof(Object) + kBytesOfInstance;

// A scene may have millions of objects.
static_assert(sizeof(Object) <= 104);

/// The size of what a name has besides the path. Instances of a node share it.
constexpr std::size_t kBytesOfName = 128;

/// Number of placements in an allocation.
constexpr std::size_t kPlacementsOfBlock = 64;

}  // namespace

template <class F>
void ObjectMaker::for_each_numbered(const std::vector<PlacedNode>& nodes, const F& f) const {
  for (const PlacedNode& placed : nodes) {
    if (!model_.nodes[placed.node].mesh || !placed.numbered) continue;
    const InstanceTransforms* instances = instances_.of(placed.node);
    f(placed, instances != nullptr ? instances->size() : 1);
  }
}

void ObjectMaker::choose_shared(const std::vector<PlacedNode>& nodes) {
  if (sharing_.instancing == Instancing::copied) return;
  for_each_numbered(nodes, [&](const PlacedNode& placed, std::size_t times) {
    uses_[*model_.nodes[placed.node].mesh] += times * sharing_.copies;
  });
  if (sharing_.instancing == Instancing::shared) return;
  std::size_t copied = 0;
  for_each_numbered(nodes, [&](const PlacedNode& placed, std::size_t times) {
    for (const Surface& surface : surfaces_[*model_.nodes[placed.node].mesh])
      if (is_shared(placed.node, surface))
        copied += times * sharing_.copies * surface.mesh.triangles.size();
  });
  if (copied <= kMostCopied) std::ranges::fill(uses_, 0);
}

bool ObjectMaker::is_shared(std::size_t node, const Surface& surface) const {
  return uses_[*model_.nodes[node].mesh] > 1 && surface.mesh.segments.empty() &&
         poser_.is_rigid(node, surface);
}

void ObjectMaker::make_room(const std::vector<PlacedNode>& nodes) {
  choose_shared(nodes);
  std::size_t runs = 0, triangles = 0, vertices = 0;
  std::uint64_t primitives = 0;  // including those of instances
  std::uint64_t bytes = 0;
  for_each_numbered(nodes, [&](const PlacedNode& placed, std::size_t times) {
    const std::size_t mesh = *model_.nodes[placed.node].mesh;
    const bool is_run = surface_of_run(placed) != nullptr;
    const std::size_t objects = is_run ? 1 : times * surfaces_[mesh].size();
    runs += objects;
    bytes += objects * kBytesOfObject + (is_run ? times * kBytesOfInstance : 0) +
             surfaces_[mesh].size() * (kBytesOfName + tree_.path(placed.node).size());
    if (!placed.visible) return;
    for (const Surface& surface : surfaces_[mesh]) {
      primitives += times * sharing_.copies * surface.mesh.triangles.size();
      if (is_shared(placed.node, surface)) continue;
      const std::size_t segments = surface.mesh.segments.size();  // drawn as quadrilaterals
      triangles += times * (surface.mesh.triangles.size() + 2 * segments);
      vertices += times * (surface.mesh.positions.size() + 4 * segments);
      bytes += times * memory_of(surface.mesh);
    }
    const auto mesh_of_node = [&] { return asset_.element("nodes", placed.node).member("mesh"); };
    if (std::max(triangles, vertices) > kMaxElements)
      asset_.fail(mesh_of_node(),
                  "brings the scene to more than 2^27 triangles or vertices, the limit",
                  ErrorKind::limit);
    if (primitives >= kNoPrimitive)
      asset_.fail(
          mesh_of_node(),
          "brings the scene to more than 2^32 - 2 triangles including those of instances, the "
          "limit",
          ErrorKind::limit);
  });
  take_memory(bytes, "the meshes of the scene with all instances");
  objects_.reserve(runs);
}

void ObjectMaker::add_mesh(const PlacedNode& placed) {
  if (!model_.nodes[placed.node].mesh || !placed.numbered) return;
  const InstanceTransforms* instances = instances_.of(placed.node);
  if (instances != nullptr && poser_.has_skin(placed.node)) {
    asset_.warn(asset_.element("nodes", placed.node),
                "has instances of a skinned mesh, which its joints place alike; one is drawn");
    instances = nullptr;
  }
  const std::vector<ObjectName> own = names(placed.node, instances != nullptr);
  if (!placed.visible) return add_hidden(placed.node, own, instances);
  if (instances == nullptr) return add_mesh(placed.node, placed.world_from_node, own, 0);
  if (const Surface* surface = surface_of_run(placed)) return add_run(placed, *surface, own[0]);
  for (std::size_t i = 0; i < instances->size(); ++i)
    add_mesh(placed.node, placed.world_from_node * (*instances)[i], own,
             static_cast<std::uint32_t>(i));
}

const Surface* ObjectMaker::surface_of_run(const PlacedNode& placed) const {
  const std::vector<Surface>& surfaces = surfaces_[*model_.nodes[placed.node].mesh];
  const bool is_run = placed.visible && instances_.of(placed.node) != nullptr &&
                      surfaces.size() == 1 && is_shared(placed.node, surfaces[0]);
  return is_run ? surfaces.data() : nullptr;
}

void ObjectMaker::add_run(const PlacedNode& placed, const Surface& surface,
                          const ObjectName& name) {
  const InstanceTransforms& instances = *instances_.of(placed.node);
  std::vector<Placement> placements;
  placements.reserve(instances.size());
  for (std::size_t i = 0; i < instances.size(); ++i) {
    placements.emplace_back(placed.world_from_node * instances[i]);
    check(*model_.nodes[placed.node].mesh, surface, is_finite(surface, placements.back()));
  }
  draws_something_ |= !placements.empty();
  objects_.push_back_run({.name = name, .shape = surface.mesh, .material = surface.material},
                         std::move(placements));
}

void ObjectMaker::check(std::size_t mesh, const Surface& surface, bool is_finite) {
  if (is_finite) return;
  asset_.warn(primitive(mesh, surface),
              "has vertices that are not finite in the world; triangles with them are not drawn");
}

void ObjectMaker::add_hidden(std::size_t node, const std::vector<ObjectName>& own,
                             const InstanceTransforms* instances) {
  const std::vector<Surface>& surfaces = surfaces_[*model_.nodes[node].mesh];
  for (std::size_t i = 0; i < (instances != nullptr ? instances->size() : 1); ++i) {
    for (std::size_t k = 0; k < surfaces.size(); ++k) {
      objects_.push_back({.name = own[k].with_number(static_cast<std::uint32_t>(i)),
                          .shape = Mesh(),
                          .material = surfaces[k].material});
    }
  }
}

void ObjectMaker::add_mesh(std::size_t node, const DMat4& world_from_mesh,
                           const std::vector<ObjectName>& own, std::uint32_t instance) {
  const std::size_t index = *model_.nodes[node].mesh;
  std::shared_ptr<const Placement> placement;  // of all surfaces
  auto name = own.begin();
  for (const Surface& surface : surfaces_[index]) {
    Mesh world;
    bool has_all = true;
    if (is_shared(node, surface)) {
      if (!placement) placement = placed(world_from_mesh);
      world = surface.mesh;
      world.placement = placement;
      has_all = is_finite(surface, *placement);
    } else {
      world = posed(node, surface, world_from_mesh);
      has_all = is_finite(world);
    }
    check(index, surface, has_all);
    draws_something_ = true;
    objects_.push_back({.name = (name++)->with_number(instance),
                        .shape = std::move(world),
                        .material = surface.material});
  }
}

std::shared_ptr<const Placement> ObjectMaker::placed(const DMat4& world_from_mesh) {
  if (!placements_ || placements_->size() == kPlacementsOfBlock) {
    placements_ = std::make_shared<std::vector<Placement>>();
    placements_->reserve(kPlacementsOfBlock);
  }
  return {placements_, &placements_->emplace_back(world_from_mesh)};
}

Mesh ObjectMaker::posed(std::size_t node, const Surface& surface, const DMat4& world_from_mesh) {
  // For temporary data. make_room has counted the mesh itself.
  MemoryAccount work(memory_account().budget());
  const MemoryScope scope(work);
  return poser_.posed(node, surface, world_from_mesh);
}

Element ObjectMaker::primitive(std::size_t mesh, const Surface& surface) const {
  return asset_.element("meshes", mesh).member("primitives").item(surface.number);
}

std::vector<ObjectName> ObjectMaker::names(std::size_t node, bool has_instances) const {
  const std::size_t index = *model_.nodes[node].mesh;
  const Model::Mesh& mesh = model_.meshes[index];
  const std::string path = tree_.path(node);
  const std::string of_mesh =
      "/" + (mesh.name.empty() ? "mesh" + std::to_string(index) : head(mesh.name, 64));
  std::vector<ObjectName> result;
  for (const Surface& surface : surfaces_[index]) {
    const std::string own =
        mesh.primitives.size() > 1 ? of_mesh + ":" + std::to_string(surface.number) : of_mesh;
    result.push_back(has_instances ? ObjectName::numbered(path + "[", "]" + own)
                                   : ObjectName(path + own));
  }
  return result;
}

}  // namespace microtrace::io::gltf
