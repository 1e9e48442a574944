#include "capi/handles.hpp"

#include <microtrace/placement.hpp>
#include <microtrace/validate.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <new>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace microtrace::capi {
namespace {

LoadOptions loading(const mt_load_options& options) {
  LoadOptions result;
  if (!std::isnan(options.time)) result.time = options.time;
  if (options.animation != nullptr) result.animation = options.animation;
  if (options.variant != nullptr) result.variant = options.variant;
  return result;
}

mt_scene* prepared(LoadedScene loaded, std::uint32_t threads) {
  std::string warnings;
  for (const Diagnostic& warning : loaded.warnings) warnings.append(warning.text()).append("\n");
  return new mt_scene{.prepared = PreparedScene(std::move(loaded.scene), {.threads = threads}),
                      .format = loaded.format,
                      .warnings = std::move(warnings)};
}

using Corners = std::array<std::uint32_t, 3>;

/// Returns a mesh attribute with `count` elements, or an empty array if `first` is NULL.
template <class T, class Number>
Array<T> array_of(const Number* first, std::size_t count, std::size_t stride, bool borrow) {
  if (first == nullptr) return {};
  const std::size_t tight = sizeof(T) / sizeof(typename T::value_type) * sizeof(Number);
  auto array =
      Array<T>::strided(first, count, static_cast<std::ptrdiff_t>(stride != 0 ? stride : tight));
  if (!borrow) (void)array.edit();
  return array;
}

Array<Corners> triangles_of(const mt_mesh& mesh, bool borrow) {
  if (mesh.triangle_count > std::numeric_limits<std::uint32_t>::max())
    throw Error(ErrorKind::limit, "", "a mesh has 2^32 triangles or more");
  if (mesh.indices != nullptr)
    return array_of<Corners>(mesh.indices, mesh.triangle_count, mesh.index_stride, borrow);
  if (mesh.short_indices != nullptr)
    return array_of<Corners>(mesh.short_indices, mesh.triangle_count, mesh.index_stride, borrow);
  if (mesh.triangle_count > mesh.position_count / 3)
    throw Error(ErrorKind::invalid_scene, "", "a mesh has fewer than three vertices a triangle");
  std::vector<Corners> triangles(mesh.triangle_count);
  std::uint32_t next = 0;
  for (Corners& corners : triangles) {
    for (std::uint32_t& corner : corners) corner = next++;
  }
  return triangles;
}

Mesh mesh_of(const mt_mesh& from) {
  if (from.position_count > 0) require(from.positions, "mt_mesh::positions");
  if (from.position_count > std::numeric_limits<std::uint32_t>::max())
    throw Error(ErrorKind::limit, "", "a mesh has 2^32 vertices or more");
  const std::size_t count = from.position_count;
  const bool borrow = from.borrow != 0;
  Mesh mesh{.positions = array_of<Vec3>(from.positions, count, from.position_stride, borrow),
            .triangles = triangles_of(from, borrow),
            .normals = array_of<Vec3>(from.normals, count, from.normal_stride, borrow),
            .colors = array_of<Vec4>(from.colors, count, from.color_stride, borrow)};
  if (from.uvs != nullptr) mesh.uv_sets = {array_of<Vec2>(from.uvs, count, from.uv_stride, borrow)};
  return mesh;
}

Material material_of(const mt_mesh& from, const Mesh& mesh) {
  const float* c = from.base_color;
  const float* e = from.emission;
  const bool is_opaque =
      !(c[3] < 1) && std::ranges::none_of(mesh.colors, [](const Vec4& v) { return v.a < 1; });
  return {.base_color = Vec4(c[0], c[1], c[2], c[3]),
          .alpha_mode = is_opaque ? AlphaMode::opaque : AlphaMode::blend,
          .double_sided = from.double_sided != 0,
          .metallic = from.metallic,
          .roughness = from.roughness,
          .emissive = Vec3(e[0], e[1], e[2])};
}

struct ColoredMesh {
  Mesh mesh;
  Material material;
};

std::vector<ColoredMesh> meshes_of(const mt_mesh* meshes, std::size_t count) {
  if (count > 0) require(meshes, "meshes");
  std::vector<ColoredMesh> result;
  result.reserve(count);
  // The caller may have been compiled with an older header, in which mt_mesh is smaller.
  const auto* bytes = reinterpret_cast<const unsigned char*>(meshes);
  const std::size_t stride = count > 0 ? meshes->size : 0;
  for (std::size_t i = 0; i < count; ++i, bytes += stride) {
    const auto& given = *reinterpret_cast<const mt_mesh*>(bytes);
    if (given.size != stride)
      throw Error(ErrorKind::usage, "",
                  "mesh " + std::to_string(i) +
                      " has another size than the first: initialize each by mt_mesh_init()");
    const mt_mesh from = complete(given, mt_mesh_init);
    Mesh mesh = mesh_of(from);
    Material material = material_of(from, mesh);
    result.push_back({.mesh = std::move(mesh), .material = std::move(material)});
  }
  return result;
}

Placement placement_of(const mt_instance& instance) {
  DMat4 scene_from_mesh(1);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column)
      scene_from_mesh[column][row] = instance.scene_from_mesh[row][column];
  }
  return Placement(scene_from_mesh);
}

Object object_of(Mesh mesh, std::size_t material) {
  return {.name = "", .shape = std::move(mesh), .material = static_cast<std::uint32_t>(material)};
}

/// Returns the scene whose object i is mesh i.
Scene scene_of(const std::vector<ColoredMesh>& meshes) {
  Scene scene;
  for (const auto& [mesh, material] : meshes) {
    scene.objects.push_back(object_of(mesh, scene.materials.size()));
    scene.materials.push_back(material);
  }
  return scene;
}

}  // namespace
}  // namespace microtrace::capi

using namespace microtrace;
using capi::guarded, capi::require, capi::complete;

void mt_load_options_init(mt_load_options* options) {
  if (options == nullptr) return;
  *options = {.size = sizeof *options,
              .time = std::numeric_limits<double>::quiet_NaN(),
              .animation = nullptr,
              .variant = nullptr,
              .threads = 0};
}

mt_status mt_scene_load(const char* path, const mt_load_options* options, mt_scene** scene) {
  return guarded([&] {
    require(path, "path");
    require(scene, "scene");
    const mt_load_options own = complete(options, mt_load_options_init);
    *scene = capi::prepared(load_scene(path, capi::loading(own)), own.threads);
  });
}

mt_status mt_scene_parse(const void* bytes, size_t byte_count, const char* folder,
                         const mt_load_options* options, mt_scene** scene) {
  return guarded([&] {
    require(bytes, "bytes");
    require(scene, "scene");
    const mt_load_options own = complete(options, mt_load_options_init);
    const std::string_view text(static_cast<const char*>(bytes), byte_count);
    *scene = capi::prepared(
        parse_scene(text, "memory", folder != nullptr ? folder : ".", capi::loading(own)),
        own.threads);
  });
}

void mt_mesh_init(mt_mesh* mesh) {
  if (mesh == nullptr) return;
  *mesh = {};
  mesh->size = sizeof *mesh;
  for (float& c : mesh->base_color) c = 1;
  mesh->double_sided = 1;
  mesh->roughness = 1;
}

mt_status mt_scene_from_meshes(const mt_mesh* meshes, size_t count, uint32_t threads,
                               mt_scene** scene) {
  return guarded([&] {
    require(scene, "scene");
    LoadedScene loaded;
    loaded.scene = capi::scene_of(capi::meshes_of(meshes, count));
    validate(loaded.scene);
    *scene = capi::prepared(std::move(loaded), threads);
  });
}

mt_status mt_scene_from_instances(const mt_mesh* meshes, size_t mesh_count,
                                  const mt_instance* instances, size_t instance_count,
                                  uint32_t threads, mt_scene** scene) {
  return guarded([&] {
    if (instance_count > 0) require(instances, "instances");
    require(scene, "scene");
    std::vector<capi::ColoredMesh> shared = capi::meshes_of(meshes, mesh_count);
    validate(capi::scene_of(shared));  // also the meshes without instances
    LoadedScene loaded;
    for (auto& [mesh, material] : shared) loaded.scene.materials.push_back(std::move(material));
    if (instance_count >= kNoPrimitive)
      throw Error(ErrorKind::limit, "", "there are 2^32 - 1 instances or more");
    std::vector<Placement> placements;  // of consecutive instances of a mesh
    for (std::size_t i = 0; i < instance_count; ++i) {
      const mt_instance& instance = instances[i];
      if (instance.mesh >= mesh_count)
        throw Error(ErrorKind::invalid_scene, "",
                    "instance " + std::to_string(i) + " is of mesh " +
                        std::to_string(instance.mesh) + ", but there are " +
                        std::to_string(mesh_count) + " meshes");
      placements.push_back(capi::placement_of(instance));
      if (i + 1 < instance_count && instances[i + 1].mesh == instance.mesh) continue;
      loaded.scene.objects.push_back_run(capi::object_of(shared[instance.mesh].mesh, instance.mesh),
                                         std::exchange(placements, {}));
    }
    validate(loaded.scene);
    *scene = capi::prepared(std::move(loaded), threads);
  });
}

void mt_scene_release(mt_scene* scene) {
  delete scene;
}

uint32_t mt_scene_primitive_count(const mt_scene* scene) {
  return scene != nullptr ? scene->prepared.bvh().primitives().count() : 0;
}

size_t mt_scene_object_count(const mt_scene* scene) {
  return scene != nullptr ? scene->prepared.scene().objects.size() : 0;
}

const char* mt_scene_object_name(const mt_scene* scene, size_t object) {
  if (scene == nullptr) return nullptr;
  const auto& objects = scene->prepared.scene().objects;
  if (object >= objects.size()) return nullptr;
  try {
    const std::scoped_lock lock(scene->names_mutex);
    auto name = scene->names.find(object);
    if (name == scene->names.end())
      name = scene->names.emplace(object, objects.name(object).str()).first;
    return name->second.c_str();
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}

const char* mt_scene_warnings(const mt_scene* scene) {
  return scene != nullptr ? scene->warnings.c_str() : nullptr;
}
