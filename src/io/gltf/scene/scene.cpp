#include "io/gltf/scene/scene.hpp"

#include "base/counted.hpp"
#include "base/memory_account.hpp"
#include "io/file_name.hpp"
#include "io/gltf/animation/animations.hpp"
#include "io/gltf/bytes/accessors.hpp"
#include "io/gltf/bytes/buffers.hpp"
#include "io/gltf/bytes/container.hpp"
#include "io/gltf/check/features.hpp"
#include "io/gltf/check/schema/schema.hpp"
#include "io/gltf/check/semantics.hpp"
#include "io/gltf/check/values/accessors.hpp"
#include "io/gltf/check/values/data.hpp"
#include "io/gltf/document/asset.hpp"
#include "io/gltf/document/asset_json.hpp"
#include "io/gltf/document/model.hpp"
#include "io/gltf/document/variants.hpp"
#include "io/gltf/material/images.hpp"
#include "io/gltf/material/materials.hpp"
#include "io/gltf/material/textures.hpp"
#include "io/gltf/mesh/surfaces.hpp"
#include "io/gltf/pose/instances.hpp"
#include "io/gltf/pose/nodes.hpp"
#include "io/gltf/pose/posing.hpp"
#include "io/gltf/scene/cameras.hpp"
#include "io/gltf/scene/choices.hpp"
#include "io/gltf/scene/lights.hpp"
#include "io/gltf/scene/object_maker.hpp"
#include "io/gltf/scene/placed_bounds.hpp"
#include "io/load_clock.hpp"
#include "scene/translation_to_origin.hpp"

#include <utility>

#include <glm/gtc/matrix_transform.hpp>

namespace microtrace::io {
namespace {

using gltf::Asset, gltf::Model, gltf::NodeTree, gltf::PlacedNode, gltf::Surface;

}  // namespace

/// All data of the file that don't depend on the pose. The members are declared in the order in
/// which they are read and checked.
struct GltfFile::Content {
  Content(std::string_view bytes, std::string file_name, const std::filesystem::path& folder,
          const LoadOptions& options)
      : detail(options.detail == SurfaceDetail::usual ? SurfaceDetail::all : options.detail),
        instancing(options.instancing),
        times(options.times),
        clock(times),
        name(std::move(file_name)),
        container(gltf::open_container(bytes, name)),
        json(container.json, container.is_glb ? name + " (JSON chunk)" : name),
        asset(json.document()),
        model(checked_model(options.variant)),
        tree(model),
        folders{.own = folder, .allowed = options.allowed_folders},
        buffers(loaded_buffers()),
        views(asset, model, buffers),
        reader(asset, model, checked_views()),
        animations(gltf::choose_animations(asset, options.animation)),
        materials(needed_materials()),
        textures(gltf::make_textures(asset)),
        surfaces(made_surfaces()),
        images(gltf::load_images(asset, views, folders, image_uses(), textures)),
        instances(asset, model, reader) {
    gltf::warn_of_ignored_features(asset, detail);
    if (!container.is_aligned) {
      asset.tolerate(asset.root(),
                     "chunks of the GLB file have lengths that are not multiples of 4");
    }
    if (json.has_latin1())
      asset.tolerate(asset.root(), "the JSON is not UTF-8; bytes that aren't are read as Latin-1");
    if (container.has_byte_order_mark)
      asset.tolerate(asset.root(), "the JSON starts with a byte order mark");
    if (container.has_zero_padding) {
      asset.tolerate(asset.root(), "the JSON chunk of the GLB file is padded with zero bytes");
    }
    if (container.extra_bytes != 0) {
      asset.warn(asset.root(), "the GLB data is followed by " +
                                   counted(container.extra_bytes, "byte") + " without effect");
    }
    clock.lap(&LoadTimes::bake);
  }

  std::vector<gltf::Buffer> loaded_buffers() {
    clock.lap(&LoadTimes::validate);
    std::vector<gltf::Buffer> result =
        gltf::load_buffers(asset, container.bin, container.is_glb, folders);
    clock.lap(&LoadTimes::read);
    return result;
  }

  Model checked_model(const std::string& variant) {
    gltf::check_requirements(asset);
    gltf::check_schema(asset);
    gltf::check_semantics(asset);
    Model result = gltf::parse_model(asset);
    gltf::check_accessors(asset, result);
    gltf::choose_variant(asset, variant, result);
    return result;
  }

  gltf::PosedAsset pose_at(double time) {
    if (!player) {
      if (animations.empty()) {
        asset.warn(asset.root(), "the asset has no animation; the time has no effect");
      }
      // Charges the player's memory to the file, which all poses share.
      const MemoryScope scope(memory);
      player.emplace(asset, model, reader, animations);
    }
    return player->at(time);
  }

  gltf::PosedAsset pose(std::optional<double> time) {
    return time ? pose_at(*time) : gltf::PosedAsset{};
  }

  LoadedScene scene(const gltf::PosedAsset& pose, const DMat4& world_from_asset,
                    std::size_t copies) {
    LoadClock lap(times);
    Asset own = asset;  // a copy, because each pose adds its own warnings
    const gltf::Element root{pose.properties ? &*pose.properties : own.root().value, {}};
    const std::vector<PlacedNode> nodes = tree.place(own, world_from_asset, pose.nodes);
    gltf::Poser poser(own, model, reader, tree, pose.nodes, world_from_asset);
    gltf::ObjectMaker maker(own, model, tree, surfaces, instances, poser, {instancing, copies});
    maker.make_room(nodes);
    for (const PlacedNode& placed : nodes) maker.add_mesh(placed);
    LoadedScene result;
    result.scene.objects = maker.take();
    result.scene.materials = gltf::make_materials(*root.value);
    gltf::add_unlit_copies(result.scene.materials, unlit);
    result.scene.textures = textures;
    result.scene.images = images;
    gltf::UnflattenedNodes unflattened(tree, world_from_asset, pose.nodes);
    result.scene.cameras = gltf::make_cameras(own, *root.value, model, tree, nodes, unflattened);
    result.scene.lights = gltf::make_lights(own, root, model, tree, nodes, unflattened);
    if (!maker.draws_something())
      own.warn(own.root(), "nothing to draw: no triangles, lines or points");
    result.warnings = own.warnings();
    lap.lap(&LoadTimes::bake);
    return result;
  }

  [[nodiscard]] PointBounds bounds(const gltf::PosedAsset& pose) {
    Asset unheard = asset;
    const std::vector<PlacedNode> nodes = tree.place(unheard, DMat4(1), pose.nodes);
    gltf::Poser poser(unheard, model, reader, tree, pose.nodes, DMat4(1));
    return gltf::bounds_of(model, nodes, surfaces, instances, poser);
  }

  std::vector<std::vector<Surface>> made_surfaces() {
    auto result = gltf::make_surfaces(asset, model, reader, materials, detail, unlit);
    gltf::add_unlit_copies(materials, unlit);
    return result;
  }

  /// Returns the materials with all layers that a pose may need. If animations may change
  /// materials, layers that are now invisible are kept.
  [[nodiscard]] std::vector<Material> needed_materials() const {
    const bool may_change = gltf::animate_materials(asset, animations);
    return gltf::make_materials(
        *asset.root().value, may_change ? gltf::UnusedLayers::kept : gltf::UnusedLayers::left_out);
  }

  const gltf::BufferViews& checked_views() {
    clock.lap(&LoadTimes::bake);
    gltf::check_data(asset, model, views);
    clock.lap(&LoadTimes::validate);
    return views;
  }

  [[nodiscard]] std::vector<gltf::ImageUse> image_uses() const {
    std::vector<bool> drawn(materials.size());
    for (const auto& mesh : surfaces) {
      for (const Surface& surface : mesh) drawn[surface.material] = true;
    }
    return gltf::image_uses(materials, drawn, textures, asset.array("images").size(), detail);
  }

  MemoryAccount& memory = memory_account();  // memory of the file, which all poses share
  SurfaceDetail detail;
  Instancing instancing;
  LoadTimes* times;
  LoadClock clock;
  std::string name;
  gltf::Container container;
  gltf::AssetJson json;
  Asset asset;
  Model model;
  NodeTree tree;
  gltf::ResourceFolders folders;
  std::vector<gltf::Buffer> buffers;
  gltf::BufferViews views;
  gltf::AccessorReader reader;
  std::vector<std::size_t> animations;  // indices of the selected animations
  std::vector<Material> materials;      // with all layers that a pose may need
  std::vector<std::uint32_t> unlit;     // indices of the materials that have unlit copies
  std::vector<Texture> textures;
  std::vector<std::vector<Surface>> surfaces;
  std::vector<std::shared_ptr<const Image>> images;
  gltf::Instances instances;
  std::optional<gltf::AnimationPlayer> player;  // made for the first pose that needs it
};

GltfFile::GltfFile(std::string_view bytes, const std::string& name,
                   const std::filesystem::path& folder, const LoadOptions& options)
    : content_(naming_file(
          name, [&] { return std::make_unique<Content>(bytes, name, folder, options); })) {}
GltfFile::~GltfFile() = default;
GltfFile::GltfFile(GltfFile&& other) noexcept = default;
GltfFile& GltfFile::operator=(GltfFile&& other) noexcept = default;

SceneChoices GltfFile::choices() const {
  return gltf::choices_of(content_->asset);
}

LoadedScene GltfFile::at(std::optional<double> time) {
  return naming_file(content_->name, [&] {
    const gltf::PosedAsset pose = content_->pose(time);
    const DVec3 way = translation_to_origin(content_->bounds(pose));
    LoadedScene result = content_->scene(pose, glm::translate(DMat4(1), way), 1);
    result.scene.origin = DVec3(0) - way;  // never -0
    return result;
  });
}

LoadedScene GltfFile::placed(std::optional<double> time, const DMat4& world_from_asset,
                             std::size_t copies) {
  return naming_file(content_->name, [&] {
    return content_->scene(content_->pose(time), world_from_asset, copies);
  });
}

}  // namespace microtrace::io
