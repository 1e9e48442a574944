#include "io/gltf/mesh/topology.hpp"

#include <algorithm>

namespace microtrace::io::gltf {
namespace {

/// Adds the triangles or segments of one run of vertices without restarts.
bool add_run(Model::Mode mode, std::span<const std::uint32_t> v, Mesh& mesh) {
  const std::size_t n = v.size();
  switch (mode) {
    case Model::Mode::points:
      for (const std::uint32_t vertex : v) mesh.segments.push_back({vertex, vertex});
      return false;
    case Model::Mode::lines:
      for (std::size_t i = 0; i + 1 < n; i += 2) mesh.segments.push_back({v[i], v[i + 1]});
      return n % 2 != 0;
    case Model::Mode::line_loop:
    case Model::Mode::line_strip:
      for (std::size_t i = 0; i + 1 < n; ++i) mesh.segments.push_back({v[i], v[i + 1]});
      if (mode == Model::Mode::line_loop && n > 1) mesh.segments.push_back({v[n - 1], v[0]});
      return n == 1;
    case Model::Mode::triangles:
      mesh.triangles.reserve(mesh.triangles.size() + n / 3);
      for (std::size_t i = 0; i + 2 < n; i += 3) {
        mesh.triangles.push_back({v[i], v[i + 1], v[i + 2]});
      }
      return n % 3 != 0;
    case Model::Mode::triangle_strip:
      for (std::size_t i = 0; i + 2 < n; ++i) {
        mesh.triangles.push_back({v[i], v[i + 1 + i % 2], v[i + 2 - i % 2]});
      }
      return n < 3;
    default:
      for (std::size_t i = 0; i + 2 < n; ++i) mesh.triangles.push_back({v[i + 1], v[i + 2], v[0]});
      return n < 3;
  }
}

template <typename Visit>
void for_each_index(Mesh& mesh, Visit&& visit) {
  for (auto& corners : mesh.triangles.edit()) {
    for (std::uint32_t& index : corners) visit(index);
  }
  for (auto& ends : mesh.segments.edit()) {
    for (std::uint32_t& index : ends) visit(index);
  }
}

/// Finds the used vertices by marking them in an array with an entry for each vertex.
std::vector<std::uint32_t> used_of_few(Mesh& mesh, std::size_t vertex_count, std::size_t uses) {
  std::vector<bool> used(vertex_count);
  for_each_index(mesh, [&](std::uint32_t index) { used[index] = true; });
  std::vector<std::uint32_t> result;
  result.reserve(std::min(vertex_count, uses));
  for (std::size_t i = 0; i < vertex_count; ++i) {
    if (used[i]) result.push_back(static_cast<std::uint32_t>(i));
  }
  return result;
}

/// Finds the used vertices by sorting the indices. The cost is independent of the accessor's
/// length, because many primitives may share a long accessor.
std::vector<std::uint32_t> used_of_many(Mesh& mesh, std::size_t uses) {
  std::vector<std::uint32_t> result;
  result.reserve(uses);
  for_each_index(mesh, [&](std::uint32_t index) { result.push_back(index); });
  std::ranges::sort(result);
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

}  // namespace

bool add_primitives(Model::Mode mode, std::span<const std::uint32_t> vertices, Mesh& mesh) {
  bool left_over = vertices.empty();
  while (!vertices.empty()) {
    const auto end = std::ranges::find(vertices, kPrimitiveRestart);
    const auto size = static_cast<std::size_t>(end - vertices.begin());
    left_over = add_run(mode, vertices.first(size), mesh) || left_over;
    vertices = vertices.subspan(std::min(size + 1, vertices.size()));
  }
  return left_over;
}

std::vector<std::uint32_t> number_vertices(Mesh& mesh, std::size_t vertex_count) {
  const std::size_t uses = mesh.triangles.size() * 3 + mesh.segments.size() * 2;
  std::vector<std::uint32_t> used =
      vertex_count / 8 <= uses ? used_of_few(mesh, vertex_count, uses) : used_of_many(mesh, uses);
  const std::size_t end = used.empty() ? 0 : std::size_t{used.back()} + 1;
  if (end == used.size()) return used;  // all vertices are used
  if (end / 8 <= uses) {
    std::vector<std::uint32_t> number_of(end);
    for (std::size_t i = 0; i < used.size(); ++i) {
      number_of[used[i]] = static_cast<std::uint32_t>(i);
    }
    for_each_index(mesh, [&](std::uint32_t& index) { index = number_of[index]; });
  } else {
    for_each_index(mesh, [&](std::uint32_t& index) {
      index = static_cast<std::uint32_t>(std::ranges::lower_bound(used, index) - used.begin());
    });
  }
  return used;
}

}  // namespace microtrace::io::gltf
