#include "io/gltf/scene.hpp"

#include "io/gltf/accessors.hpp"
#include "io/gltf/animations.hpp"
#include "io/gltf/asset.hpp"
#include "io/gltf/buffers.hpp"
#include "io/gltf/cameras.hpp"
#include "io/gltf/check/data.hpp"
#include "io/gltf/check/schema.hpp"
#include "io/gltf/check/semantics.hpp"
#include "io/gltf/container.hpp"
#include "io/gltf/features.hpp"
#include "io/gltf/images.hpp"
#include "io/gltf/instances.hpp"
#include "io/gltf/lights.hpp"
#include "io/gltf/materials.hpp"
#include "io/gltf/model.hpp"
#include "io/gltf/nodes.hpp"
#include "io/gltf/posing.hpp"
#include "io/gltf/surfaces.hpp"
#include "io/gltf/textures.hpp"
#include "io/gltf/variants.hpp"
#include "io/load_clock.hpp"
#include "scene/support.hpp"

#include <algorithm>
#include <new>
#include <stdexcept>
#include <utility>

#include <glm/matrix.hpp>

namespace microtrace::io {
namespace {

using gltf::Asset, gltf::Element, gltf::NodeTree, gltf::PlacedNode, gltf::Surface;

bool is_finite(const Mesh& mesh) {
  return std::ranges::all_of(mesh.positions,
                             [](const Vec3& p) { return microtrace::is_finite(p); });
}

class SceneMaker {
 public:
  SceneMaker(Asset& asset, const tinygltf::Model& model, const NodeTree& tree,
             const std::vector<std::vector<Surface>>& surfaces, const gltf::Instances& instances,
             gltf::Poser& poser)
      : asset_(asset),
        model_(model),
        tree_(tree),
        surfaces_(surfaces),
        instances_(instances),
        poser_(poser) {}

  /// Throws Error (limit) before memory is taken for too many instances.
  void check_size(const std::vector<PlacedNode>& nodes) const {
    std::size_t triangles = 0, vertices = 0;
    for (const PlacedNode& placed : nodes) {
      const int mesh = model_.nodes[placed.node].mesh;
      if (mesh < 0 || !placed.visible) continue;
      const std::vector<DMat4>* instances = instances_.of(placed.node);
      const std::size_t times = instances != nullptr ? instances->size() : 1;
      for (const Surface& surface : surfaces_[static_cast<std::size_t>(mesh)]) {
        const std::size_t segments = surface.mesh.segments.size();  // widened to draw them
        triangles += times * (surface.mesh.triangles.size() + 2 * segments);
        vertices += times * (surface.mesh.positions.size() + 4 * segments);
      }
      if (std::max(triangles, vertices) <= gltf::max_elements) continue;
      asset_.fail(asset_.element("nodes", placed.node).member("mesh"),
                  "brings the scene to more than 2^27 triangles or vertices, the most that is read",
                  ErrorKind::limit);
    }
  }

  void add_mesh(const PlacedNode& placed) {
    if (model_.nodes[placed.node].mesh < 0 || !placed.visible) return;
    const std::string path = tree_.path(placed.node);
    const std::vector<DMat4>* instances = instances_.of(placed.node);
    if (instances != nullptr && poser_.has_skin(placed.node)) {
      asset_.warn(asset_.element("nodes", placed.node),
                  "has instances of a skinned mesh, all in the place of its joints; one is drawn");
      instances = nullptr;
    }
    if (instances == nullptr) return add_mesh(placed.node, placed.world_from_node, path);
    for (std::size_t i = 0; i < instances->size(); ++i) {
      add_mesh(placed.node, placed.world_from_node * (*instances)[i],
               path + "[" + std::to_string(i) + "]");
    }
  }

  [[nodiscard]] std::vector<Object> take() { return std::move(objects_); }

 private:
  void add_mesh(std::size_t node, const DMat4& world_from_mesh, const std::string& path) {
    const auto index = static_cast<std::size_t>(model_.nodes[node].mesh);
    for (const Surface& surface : surfaces_[index]) {
      Mesh world = poser_.posed(node, surface, world_from_mesh);
      if (!is_finite(world)) {
        asset_.warn(primitive(index, surface),
                    "has vertices that are not finite in the world; triangles with them are not "
                    "drawn");
      }
      objects_.push_back({.name = names_.make(name(path, index, surface)),
                          .shape = std::move(world),
                          .material = surface.material});
    }
  }

  [[nodiscard]] Element primitive(std::size_t mesh, const Surface& surface) const {
    return asset_.element("meshes", mesh).member("primitives").item(surface.number);
  }

  [[nodiscard]] std::string name(const std::string& path, std::size_t mesh,
                                 const Surface& surface) const {
    const tinygltf::Mesh& source = model_.meshes[mesh];
    std::string result = path + "/";
    result += source.name.empty() ? "mesh" + std::to_string(mesh) : gltf::head(source.name, 64);
    if (source.primitives.size() > 1) result += ":" + std::to_string(surface.number);
    return result;
  }

  Asset& asset_;
  const tinygltf::Model& model_;
  const NodeTree& tree_;
  const std::vector<std::vector<Surface>>& surfaces_;
  const gltf::Instances& instances_;
  gltf::Poser& poser_;
  std::vector<Object> objects_;
  gltf::UniqueNames names_;
};

/// Runs a part of the reading; whatever it throws becomes an Error.
template <typename Part>
auto guarded(const std::string& name, Part&& part) {
  try {
    return part();
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw Error(ErrorKind::limit, name, "the asset needs more memory than there is");
  } catch (const std::exception& error) {
    throw Error(ErrorKind::internal, name, std::string("reading glTF failed: ") + error.what());
  }
}

}  // namespace

/// Everything but poses, in the order in which it is read and checked.
struct GltfFile::Content {
  Content(std::string_view bytes, const std::string& file_name, const std::filesystem::path& folder,
          const LoadOptions& options)
      : detail(options.detail == SurfaceDetail::usual ? SurfaceDetail::all : options.detail),
        times(options.times),
        clock(times),
        name(file_name),
        container(gltf::open_container(bytes, name)),
        json(container.json, container.is_glb ? name + " (JSON chunk)" : name, max_json_values,
             RepeatedKeys::last_counts),
        asset(json),
        model(checked_model(options.variant)),
        tree(model),
        folders{.own = folder, .allowed = options.allowed_folders},
        buffers(loaded_buffers()),
        views(asset, model, buffers),
        reader(asset, model, checked_views()),
        materials(gltf::make_materials(asset)),
        textures(gltf::make_textures(asset)),
        surfaces(gltf::make_surfaces(asset, model, reader, materials, detail)),
        images(gltf::load_images(asset, views, folders, wanted_images())),
        instances(asset, model, reader),
        animations(gltf::choose_animations(asset, options.animation)) {
    gltf::warn_of_ignored_features(asset, detail);
    if (!container.is_aligned) {
      asset.warn(asset.root(), "chunks of the GLB file have lengths that are no multiples of 4");
    }
    if (container.extra_bytes != 0) {
      asset.warn(asset.root(), std::to_string(container.extra_bytes) +
                                   " bytes after the end of the GLB file are ignored");
    }
    clock.lap(&LoadTimes::bake);
  }

  std::vector<gltf::Buffer> loaded_buffers() {
    clock.lap(&LoadTimes::validate);
    std::vector<gltf::Buffer> result = gltf::load_buffers(asset, container.bin, folders);
    clock.lap(&LoadTimes::read);
    return result;
  }

  tinygltf::Model checked_model(const std::string& variant) {
    gltf::check_requirements(asset);
    gltf::check_schema(asset);
    gltf::check_semantics(asset);
    tinygltf::Model result = gltf::parse_model(asset);
    gltf::check_accessors(asset, result);
    gltf::choose_variant(asset, variant, result);
    return result;
  }

  gltf::PosedNodes pose_at(double time) {
    if (!player) {
      if (animations.empty()) {
        asset.warn(asset.root(), "the asset has no animation; the time makes no difference");
      }
      player.emplace(asset, model, reader, animations);
    }
    return player->at(time);
  }

  const gltf::BufferViews& checked_views() {
    clock.lap(&LoadTimes::bake);
    gltf::check_data(asset, model, views);
    clock.lap(&LoadTimes::validate);
    return views;
  }

  [[nodiscard]] std::vector<bool> wanted_images() const {
    std::vector<bool> drawn(materials.size());
    for (const auto& mesh : surfaces) {
      for (const Surface& surface : mesh) drawn[surface.material] = true;
    }
    return gltf::wanted_images(materials, drawn, textures, asset.array("images").size(), detail);
  }

  SurfaceDetail detail;
  LoadTimes* times;
  LoadClock clock;
  std::string name;
  gltf::Container container;
  JsonDocument json;
  Asset asset;
  tinygltf::Model model;
  NodeTree tree;
  gltf::ResourceFolders folders;
  std::vector<gltf::Buffer> buffers;
  gltf::BufferViews views;
  gltf::AccessorReader reader;
  std::vector<Material> materials;
  std::vector<Texture> textures;
  std::vector<std::vector<Surface>> surfaces;
  std::vector<std::shared_ptr<const Image>> images;
  gltf::Instances instances;
  std::vector<std::size_t> animations;          // chosen
  std::optional<gltf::AnimationPlayer> player;  // of them, once a time was asked for
};

GltfFile::GltfFile(std::string_view bytes, const std::string& name,
                   const std::filesystem::path& folder, const LoadOptions& options)
    : content_(
          guarded(name, [&] { return std::make_unique<Content>(bytes, name, folder, options); })) {}
GltfFile::~GltfFile() = default;
GltfFile::GltfFile(GltfFile&& other) noexcept = default;
GltfFile& GltfFile::operator=(GltfFile&& other) noexcept = default;

LoadedScene GltfFile::at(std::optional<double> time, const DMat4& world_from_asset) {
  return guarded(content_->name, [&] {
    const gltf::PosedNodes pose = time ? content_->pose_at(*time) : gltf::PosedNodes{};
    LoadClock clock(content_->times);
    Asset asset = content_->asset;  // each pose adds warnings of its own
    const tinygltf::Model& model = content_->model;
    const NodeTree& tree = content_->tree;
    const std::vector<PlacedNode> nodes = tree.place(asset, world_from_asset, pose);
    gltf::Poser poser(asset, model, content_->reader, tree, pose, world_from_asset);
    SceneMaker maker(asset, model, tree, content_->surfaces, content_->instances, poser);
    maker.check_size(nodes);
    for (const PlacedNode& placed : nodes) maker.add_mesh(placed);
    LoadedScene result;
    result.scene.objects = maker.take();
    result.scene.materials = content_->materials;
    result.scene.textures = content_->textures;
    result.scene.images = content_->images;
    result.scene.cameras = gltf::make_cameras(asset, model, tree, nodes);
    result.scene.lights = gltf::make_lights(asset, model, tree, nodes);
    if (result.scene.objects.empty())
      asset.warn(asset.root(), "nothing to draw: no triangles, lines or points");
    result.warnings = asset.warnings();
    clock.lap(&LoadTimes::bake);
    return result;
  });
}

LoadedScene load_gltf(std::string_view bytes, const std::string& name,
                      const std::filesystem::path& folder, const DMat4& world_from_asset,
                      const LoadOptions& options) {
  return GltfFile(bytes, name, folder, options).at(options.time, world_from_asset);
}

}  // namespace microtrace::io
