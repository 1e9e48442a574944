#include "io/gltf/pose/morphing.hpp"

#include "base/memory_account.hpp"
#include "io/gltf/document/index_text.hpp"

#include <algorithm>

namespace microtrace::io::gltf {
namespace {

template <typename To, typename From>
std::vector<To> converted(const Array<From>& from) {
  return {from.begin(), from.end()};
}

/// Adds weight * delta to the sums. Empty sums first get the base vectors.
template <typename Sum, typename Base, typename Delta>
void add_weighted(std::vector<Sum>& sum, const Array<Base>& base, double weight,
                  const std::vector<Delta>& deltas) {
  if (base.empty()) return;
  if (sum.empty()) sum = converted<Sum>(base);
  using Number = typename Sum::value_type;
  for (std::size_t i = 0; i < sum.size(); ++i) {
    for (glm::length_t k = 0; k < std::min(Sum::length(), Delta::length()); ++k) {
      sum[i][k] += static_cast<Number>(weight * deltas[i][k]);
    }
  }
}

}  // namespace

Morphed Morpher::morphed(std::size_t mesh, const Surface& surface,
                         const std::vector<double>& weights) {
  const Model::Primitive& primitive = model_.meshes[mesh].primitives[surface.number];
  Morphed result;
  const auto moves = [](double weight) { return weight != 0; };
  if (!primitive.targets.empty() && std::ranges::any_of(weights, moves)) {
    const Mesh& own = surface.mesh;
    const std::size_t sums = 1U + (own.normals.empty() ? 0 : 1) + (own.tangents.empty() ? 0 : 1);
    take_memory(surface.vertices.size() * sums * sizeof(DVec3), "moving vertices by morph targets");
  }
  for (std::size_t i = 0; i < std::min(primitive.targets.size(), weights.size()); ++i) {
    if (weights[i] == 0) continue;
    for (const auto& [name, accessor] : primitive.targets[i]) {
      const auto at = [&, &attribute = name] {
        return asset_.element("meshes", mesh)
            .member("primitives")
            .item(surface.number)
            .member("targets")
            .item(i)
            .member(attribute);
      };
      if (!reader_.has_data(accessor)) {
        asset_.warn(at(), "needs data that is not there; it is not applied");
        continue;
      }
      displacements_ += std::max(surface.vertices.size(), kLeastDisplacements);
      if (displacements_ > kMaxDisplacements) {
        asset_.fail(at(), "brings a pose to more than 2^29 vertex displacements, the limit",
                    ErrorKind::limit);
      }
      add(accessor, name, weights[i], surface, result);
    }
  }
  for (Vec4& color : result.colors) color = glm::clamp(color, Vec4(0), Vec4(1));
  return result;
}

void Morpher::add(std::size_t accessor, const std::string& name, double weight,
                  const Surface& surface, Morphed& result) {
  // The memory of the data read here is released on return. The float64 sums live until the mesh is
  // baked.
  MemoryAccount deltas_memory(memory_account().budget());
  const MemoryScope scope(deltas_memory);
  const Mesh& mesh = surface.mesh;
  const auto deltas = [&]<typename Vector>(Vector) {
    return reader_.read_finite<Vector>(accessor, surface.vertices);
  };
  if (name == "POSITION") {
    add_weighted(result.positions, mesh.positions, weight, deltas(Vec3()));
  } else if (name == "NORMAL") {
    if (!mesh.normals.empty()) add_weighted(result.normals, mesh.normals, weight, deltas(Vec3()));
  } else if (name == "TANGENT") {
    if (!mesh.tangents.empty()) {
      add_weighted(result.tangents, mesh.tangents, weight, deltas(Vec3()));
    }
  } else if (name.starts_with("TEXCOORD_")) {
    const std::size_t set = set_in(name).value_or(0);
    if (set >= mesh.uv_sets.size() || mesh.uv_sets[set].empty()) return;
    if (result.uv_sets.empty()) result.uv_sets = mesh.uv_sets;
    add_weighted(result.uv_sets[set].edit(), mesh.uv_sets[set], weight, deltas(Vec2()));
  } else if (name == "COLOR_0" && !mesh.colors.empty()) {
    if (model_.accessors[accessor].type == ElementType::vec4) {
      add_weighted(result.colors, mesh.colors, weight, deltas(Vec4()));
    } else {
      add_weighted(result.colors, mesh.colors, weight, deltas(Vec3()));
    }
  }
}

}  // namespace microtrace::io::gltf
