#include "scene/mesh/tangents.hpp"

#include "base/memory_account.hpp"
#include "scene/mesh/tangent_groups.hpp"

#include <microtrace/error.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <tuple>

#include <glm/geometric.hpp>

namespace microtrace {
namespace {

/// The values at these indices; empty if `values` is empty.
template <typename Value>
std::vector<Value> picked(const Array<Value>& values, std::span<const std::uint32_t> numbers) {
  std::vector<Value> result;
  if (values.empty()) return result;
  result.reserve(numbers.size());
  for (const std::uint32_t i : numbers) result.push_back(values[i]);
  return result;
}

Vec3 flat_normal(const Mesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
  const DVec3 a(mesh.positions[triangle[0]]);
  const DVec3 cross =
      glm::cross(DVec3(mesh.positions[triangle[1]]) - a, DVec3(mesh.positions[triangle[2]]) - a);
  const double square = glm::dot(cross, cross);
  return square > 0 ? Vec3(cross / std::sqrt(square)) : Vec3(0);
}

/// Splits vertices whose corners have different tangents. tangents[i] belongs to corner i, numbered
/// across all triangles.
std::vector<std::uint32_t> split(Mesh& mesh, std::span<const Vec4> tangents) {
  const std::size_t vertex_count = mesh.positions.size();
  std::vector<std::array<std::uint32_t, 3>>& triangles = mesh.triangles.edit();
  const auto vertex_at = [&](std::size_t corner) -> std::uint32_t& {
    return triangles[corner / 3][corner % 3];
  };
  // Sorts corners by vertex (counting sort).
  std::vector<std::uint32_t> first(vertex_count + 1);
  for (std::size_t i = 0; i < tangents.size(); ++i) ++first[vertex_at(i) + 1];
  for (std::size_t v = 0; v < vertex_count; ++v) first[v + 1] += first[v];
  std::vector<std::uint32_t> corners(tangents.size());
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  for (std::size_t i = 0; i < tangents.size(); ++i) {
    corners[next[vertex_at(i)]++] = static_cast<std::uint32_t>(i);
  }

  const auto less = [&](std::uint32_t a, std::uint32_t b) {
    const Vec4 &s = tangents[a], &t = tangents[b];
    return std::tie(s.x, s.y, s.z, s.w, a) < std::tie(t.x, t.y, t.z, t.w, b);
  };
  std::vector<std::uint32_t> origin, standard(vertex_count);
  mesh.tangents.clear();
  for (std::uint32_t v = 0; v < vertex_count; ++v) {
    standard[v] = static_cast<std::uint32_t>(origin.size());
    const std::span<std::uint32_t> here(corners.data() + first[v], corners.data() + first[v + 1]);
    std::ranges::sort(here, less);
    for (std::size_t i = 0; i < here.size(); ++i) {
      if (i == 0 || tangents[here[i]] != tangents[here[i - 1]]) {
        origin.push_back(v);
        mesh.tangents.push_back(tangents[here[i]]);
      }
      vertex_at(here[i]) = static_cast<std::uint32_t>(origin.size() - 1);
    }
    if (!here.empty()) continue;  // otherwise no triangle uses the vertex
    origin.push_back(v);
    mesh.tangents.push_back(tangent_across(mesh.normals.empty() ? Vec3(0) : mesh.normals[v]));
  }
  for (auto& segment : mesh.segments.edit()) {
    for (std::uint32_t& vertex : segment) vertex = standard[vertex];
  }
  mesh.positions = picked(mesh.positions, origin);
  mesh.normals = picked(mesh.normals, origin);
  mesh.colors = picked(mesh.colors, origin);
  for (auto& set : mesh.uv_sets) set = picked(set, origin);
  return origin;
}

/// Treats each triangle as if it had its own vertices with its geometric normal.
std::vector<Vec4> flat_tangents(const Mesh& mesh, std::size_t uv_set) {
  std::vector<Vec3> positions, normals;
  std::vector<Vec2> uv;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const auto& triangle : mesh.triangles) {
    const auto number = static_cast<std::uint32_t>(positions.size());
    triangles.push_back({number, number + 1, number + 2});
    for (const std::uint32_t vertex : triangle) {
      positions.push_back(mesh.positions[vertex]);
      normals.push_back(flat_normal(mesh, triangle));
      uv.push_back(mesh.uv_sets[uv_set][vertex]);
    }
  }
  return corner_tangents(
      {.positions = positions, .normals = normals, .uv = uv, .triangles = triangles});
}

/// Returns the set of texture coordinates that defines the material's tangents, if the material
/// needs tangents.
std::optional<std::uint32_t> tangent_set(const Material& material) {
  if (material.normal_texture) return material.normal_texture->uv_set;
  if (material.clearcoat && material.clearcoat->normal_texture) {
    return material.clearcoat->normal_texture->uv_set;
  }
  if (!material.anisotropy) return std::nullopt;
  return material.anisotropy->texture ? material.anisotropy->texture->uv_set : 0;
}

}  // namespace

std::optional<std::uint32_t> missing_tangents(const Material& material, const Mesh& mesh) {
  const std::optional<std::uint32_t> set = tangent_set(material);
  if (!set || !mesh.tangents.empty() || mesh.triangles.empty()) return std::nullopt;
  if (*set >= mesh.uv_sets.size() || mesh.uv_sets[*set].empty()) return std::nullopt;
  return set;
}

std::vector<std::uint32_t> make_tangents(Mesh& mesh, std::size_t uv_set) {
  if (mesh.triangles.size() > std::numeric_limits<std::uint32_t>::max() / 3)
    throw Error(ErrorKind::limit, "", "a mesh has too many triangles for generating tangents");
  // Generating tangents may add three vertices per triangle.
  constexpr std::size_t kBytesOfWork = 300, kBytesOfTangents = sizeof(Vec4) / 2;
  const MemoryAccount work =
      temporary_memory(mesh.triangles.size() * kBytesOfWork, "making tangents");
  take_memory(mesh.triangles.size() * kBytesOfTangents, "the tangents of meshes");
  if (mesh.normals.empty()) return split(mesh, flat_tangents(mesh, uv_set));
  return split(mesh, corner_tangents({.positions = mesh.positions,
                                      .normals = mesh.normals,
                                      .uv = mesh.uv_sets[uv_set],
                                      .triangles = mesh.triangles}));
}

}  // namespace microtrace
