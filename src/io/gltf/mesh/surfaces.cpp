#include "io/gltf/mesh/surfaces.hpp"

#include "base/memory_account.hpp"
#include "io/gltf/mesh/draco.hpp"
#include "io/gltf/mesh/topology.hpp"
#include "io/gltf/mesh/vertex_attributes.hpp"
#include "scene/mesh/tangents.hpp"
#include "scene/support.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <utility>

namespace microtrace::io::gltf {
namespace {

std::size_t bytes_of_topology(Model::Mode mode, std::size_t vertices) {
  const bool one_for_each = mode != Model::Mode::triangles && mode != Model::Mode::lines;
  return vertices * sizeof(std::uint32_t) * (one_for_each ? 3 : 1);
}

/// Removes vertices that are not finite, and the triangles and segments that use them. Returns true
/// if any vertex was removed.
bool leave_out_infinite(Surface& surface) {
  Mesh& mesh = surface.mesh;
  const auto is_bad = [&](std::uint32_t i) { return !is_finite(mesh.positions[i]); };
  const auto has_bad = [&](const auto& corners) { return std::ranges::any_of(corners, is_bad); };
  const std::size_t bad =
      std::erase_if(mesh.triangles.edit(), has_bad) + std::erase_if(mesh.segments.edit(), has_bad);
  if (bad == 0) return false;
  std::vector<std::uint32_t> vertices;
  std::vector<Vec3> positions;
  for (const std::uint32_t i : number_vertices(mesh, mesh.positions.size())) {
    vertices.push_back(surface.vertices[i]);
    positions.push_back(mesh.positions[i]);
  }
  surface.vertices = std::move(vertices);
  mesh.positions = std::move(positions);
  return true;
}

class SurfaceMaker {
 public:
  SurfaceMaker(Asset& asset, const Model& model, AccessorReader& reader,
               std::span<const Material> materials, SurfaceDetail detail,
               std::vector<std::uint32_t>& unlit)
      : asset_(asset),
        model_(model),
        reader_(reader),
        draco_(asset, model, reader.views(), reader),
        materials_(materials),
        unlit_(unlit),
        detail_(detail) {}

  std::optional<Surface> make(const Element& at, const Model::Primitive& primitive) {
    const auto position = primitive.attributes.find("POSITION");
    if (position == primitive.attributes.end()) {
      asset_.warn(at, "has no POSITION attribute; nothing is drawn for it");
      return std::nullopt;
    }
    const bool is_draco = draco_.decode(at, primitive);
    if (!reader_.has_data(position->second) ||
        (primitive.indices && !reader_.has_data(*primitive.indices))) {
      asset_.warn(
          at,
          "needs data that is not there: its buffer has no uri and is not the BIN chunk, or an "
          "accessor is empty; nothing is drawn for it");
      return std::nullopt;
    }
    MemoryAccount indices(memory_account().budget());
    const std::vector<std::uint32_t> vertices =
        vertices_of(at, primitive, position->second, indices);
    take_memory(bytes_of_topology(primitive.mode, vertices.size()), "the triangles of meshes");
    Surface result{.material = material_of(primitive)};
    const Model::Mode mode = is_draco ? Model::Mode::triangles : primitive.mode;
    if (add_primitives(mode, vertices, result.mesh)) {
      asset_.warn(at, "ends with an incomplete triangle or line; it is left out");
    }
    if (result.mesh.triangles.empty() && result.mesh.segments.empty()) return std::nullopt;
    const std::size_t uses = 3 * result.mesh.triangles.size() + 2 * result.mesh.segments.size();
    take_memory(std::min(uses, reader_.count(position->second)) * sizeof(std::uint32_t),
                "the vertices of meshes");
    result.vertices = number_vertices(result.mesh, reader_.count(position->second));
    result.mesh.positions = reader_.read<Vec3>(position->second, result.vertices);
    if (leave_out_infinite(result)) {
      asset_.tolerate(
          at, "has vertices that are not finite; triangles and lines with them are not drawn");
      if (result.vertices.empty()) return std::nullopt;
    }
    read_attributes(asset_, model_, reader_, at.member("attributes"), primitive, result.vertices,
                    {.material = materials_[result.material], .detail = detail_}, result.mesh);
    if (detail_ == SurfaceDetail::all) add_tangents(result);
    // glTF 2.0, Point and Line Materials: points and lines without normals are unlit.
    const bool has_normals = primitive.attributes.contains("NORMAL");
    if (!result.mesh.segments.empty() && !has_normals) result.material = unlit(result.material);
    for (const Vec3& p : result.mesh.positions) result.box.add(DVec3(p));
    return result;
  }

 private:
  /// Returns the index of the primitive's material. Primitives without one use the default
  /// material, which make_materials appends.
  std::uint32_t material_of(const Model::Primitive& primitive) const {
    if (primitive.material) return static_cast<std::uint32_t>(*primitive.material);
    return static_cast<std::uint32_t>(materials_.size() - 1);
  }

  /// Returns the index of a material's unlit copy, which add_unlit_copies will make later.
  std::uint32_t unlit(std::uint32_t material) {
    auto found = std::ranges::find(unlit_, material);
    if (found == unlit_.end()) found = unlit_.insert(found, material);
    return static_cast<std::uint32_t>(materials_.size()) +
           static_cast<std::uint32_t>(found - unlit_.begin());
  }

  /// Generates the tangents that are missing.
  void add_tangents(Surface& surface) const {
    Mesh& mesh = surface.mesh;
    const auto set = missing_tangents(materials_[surface.material], mesh);
    if (!set) return;
    std::vector<std::uint32_t> vertices;
    for (const std::uint32_t i : make_tangents(mesh, *set)) vertices.push_back(surface.vertices[i]);
    surface.vertices = std::move(vertices);
  }

  void check_count(const Element& at, std::size_t count) {
    if (count > kMaxElements - elements_) {
      asset_.fail(at, "brings the asset to more than 2^27 elements, the limit", ErrorKind::limit);
    }
    elements_ += count;
  }

  std::vector<std::uint32_t> vertices_of(const Element& at, const Model::Primitive& primitive,
                                         std::size_t position, MemoryAccount& memory) {
    const MemoryScope scope(memory);
    const std::size_t vertex_count = reader_.count(position);
    if (!primitive.indices) {
      check_count(at, vertex_count);
      take_memory(vertex_count * sizeof(std::uint32_t), "the vertices of meshes");
      std::vector<std::uint32_t> result(vertex_count);
      std::iota(result.begin(), result.end(), 0U);
      return result;
    }
    const Model::Accessor& indices = model_.accessors[*primitive.indices];
    check_count(at.member("indices"), reader_.count(*primitive.indices));
    std::vector<std::uint32_t> result = reader_.read<std::uint32_t>(*primitive.indices);
    const Element source = asset_.element("accessors", *primitive.indices);
    const std::uint64_t greatest =
        (std::uint64_t{1} << 8 * component_size(indices.component_type)) - 1;
    bool restarts = false;
    for (std::uint32_t& vertex : result) {
      if (vertex < vertex_count && vertex != greatest) continue;
      if (vertex != greatest) {
        asset_.fail(source, "element " + std::to_string(&vertex - result.data()) + " is vertex " +
                                std::to_string(vertex) + " of only " +
                                std::to_string(vertex_count));
      }
      vertex = kPrimitiveRestart;
      restarts = true;
    }
    if (restarts && !asset_.uses("EXT_mesh_primitive_restart")) {
      asset_.tolerate(source,
                      "has the primitive restart value, which glTF 2.0 forbids; a new "
                      "primitive starts there");
    }
    return result;
  }

  Asset& asset_;
  const Model& model_;
  AccessorReader& reader_;
  DracoDecoder draco_;
  std::span<const Material> materials_;
  std::vector<std::uint32_t>& unlit_;
  SurfaceDetail detail_;
  std::size_t elements_ = 0;  // total count, limited by kMaxElements
};

}  // namespace

std::vector<std::vector<Surface>> make_surfaces(Asset& asset, const Model& model,
                                                AccessorReader& reader,
                                                std::span<const Material> materials,
                                                SurfaceDetail detail,
                                                std::vector<std::uint32_t>& unlit) {
  SurfaceMaker maker(asset, model, reader, materials, detail, unlit);
  std::vector<std::vector<Surface>> result(model.meshes.size());
  for (std::size_t i = 0; i < result.size(); ++i) {
    const Element primitives = asset.element("meshes", i).member("primitives");
    for (std::size_t k = 0; k < model.meshes[i].primitives.size(); ++k) {
      std::optional<Surface> surface =
          maker.make(primitives.item(k), model.meshes[i].primitives[k]);
      if (!surface) continue;
      surface->number = k;
      result[i].push_back(std::move(*surface));
    }
  }
  return result;
}

}  // namespace microtrace::io::gltf
