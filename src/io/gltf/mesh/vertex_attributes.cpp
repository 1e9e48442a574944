#include "io/gltf/mesh/vertex_attributes.hpp"

#include "io/gltf/check/texture_infos.hpp"

#include <algorithm>
#include <optional>
#include <string>

namespace microtrace::io::gltf {
namespace {

class AttributeReader {
 public:
  AttributeReader(Asset& asset, const Model& model, AccessorReader& reader,
                  const Element& attributes, const Model::Primitive& primitive,
                  std::span<const std::uint32_t> vertices)
      : asset_(asset),
        model_(model),
        reader_(reader),
        attributes_(attributes),
        primitive_(primitive),
        vertices_(vertices) {}

  [[nodiscard]] std::vector<Vec3> normals() {
    const std::optional<std::size_t> accessor = find("NORMAL", {ElementType::vec3});
    return accessor ? reader_.read_finite<Vec3>(*accessor, vertices_) : std::vector<Vec3>();
  }

  [[nodiscard]] std::vector<Vec4> tangents() {
    const std::optional<std::size_t> accessor = find("TANGENT", {ElementType::vec4});
    return accessor ? reader_.read_finite<Vec4>(*accessor, vertices_) : std::vector<Vec4>();
  }

  [[nodiscard]] std::vector<Vec2> uv_set(std::uint32_t set) {
    const std::optional<std::size_t> accessor =
        find("TEXCOORD_" + std::to_string(set), {ElementType::vec2});
    return accessor ? reader_.read_finite<Vec2>(*accessor, vertices_) : std::vector<Vec2>();
  }

  /// Reads colors. Colors without alpha are opaque.
  [[nodiscard]] std::vector<Vec4> colors() {
    const std::optional<std::size_t> accessor =
        find("COLOR_0", {ElementType::vec3, ElementType::vec4});
    if (!accessor) return {};
    std::vector<Vec4> result;
    if (model_.accessors[*accessor].type == ElementType::vec4) {
      result = reader_.read_finite<Vec4>(*accessor, vertices_);
    } else {
      result.reserve(vertices_.size());
      for (const Vec3& rgb : reader_.read_finite<Vec3>(*accessor, vertices_))
        result.emplace_back(rgb, 1);
    }
    return result;
  }

 private:
  /// Returns the accessor of an attribute, if the primitive has it and its data is present.
  std::optional<std::size_t> find(const std::string& name,
                                  std::initializer_list<ElementType> types) {
    const auto attribute = primitive_.attributes.find(name);
    if (attribute == primitive_.attributes.end()) return std::nullopt;
    const std::size_t accessor = attribute->second;
    if (std::ranges::find(types, model_.accessors[accessor].type) == types.end()) {
      asset_.fail(
          attributes_.member(name),
          "must refer to an accessor of type VEC" +
              std::to_string(component_count(*types.begin())) +
              (types.size() > 1 ? " or VEC" + std::to_string(component_count(*(types.end() - 1)))
                                : ""));
    }
    if (reader_.has_data(accessor)) return accessor;
    asset_.warn(attributes_.member(name), "has no data; the attribute is left out");
    return std::nullopt;
  }

  Asset& asset_;
  const Model& model_;
  AccessorReader& reader_;
  const Element& attributes_;
  const Model::Primitive& primitive_;
  std::span<const std::uint32_t> vertices_;
};

/// Returns true if the material or the caller needs this set of texture coordinates.
bool is_wanted(std::uint32_t set, const AttributeWish& wish) {
  if (wish.detail != SurfaceDetail::color) return true;
  const auto& use = wish.material.base_color_texture;
  return use && use->uv_set == set;
}

}  // namespace

void read_attributes(Asset& asset, const Model& model, AccessorReader& reader,
                     const Element& attributes, const Model::Primitive& primitive,
                     std::span<const std::uint32_t> vertices, const AttributeWish& wish,
                     Mesh& mesh) {
  AttributeReader attribute(asset, model, reader, attributes, primitive, vertices);
  mesh.colors = attribute.colors();
  for (std::uint32_t set = 0; set < kMaxUvSets; ++set) {
    if (!is_wanted(set, wish)) continue;
    std::vector<Vec2> uv = attribute.uv_set(set);
    if (uv.empty()) continue;
    mesh.uv_sets.resize(set + 1);
    mesh.uv_sets[set] = std::move(uv);
  }
  if (wish.detail == SurfaceDetail::color) return;
  mesh.normals = attribute.normals();
  // Without normals, tangents are ignored (glTF 2.0, section 3.7.2.1).
  if (!mesh.normals.empty()) mesh.tangents = attribute.tangents();
}

}  // namespace microtrace::io::gltf
