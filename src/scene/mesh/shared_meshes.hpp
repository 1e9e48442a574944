#pragma once
/// Recognizes placed meshes that share all of their arrays, so that each is examined once.

#include <microtrace/shape.hpp>

#include <compare>
#include <cstddef>
#include <functional>
#include <unordered_map>

namespace microtrace {

/// Identifies the values of an array. Arrays of different sizes may begin at the same address.
struct ArrayKey {
  const void* data;
  std::size_t size;

  template <class T>
  explicit ArrayKey(const Array<T>& array) : data(array.data()), size(array.size()) {}
  auto operator<=>(const ArrayKey&) const = default;

  struct Hash {
    std::size_t operator()(const ArrayKey& key) const {
      return std::hash<const void*>{}(key.data) * 31 + key.size;
    }
  };
};

/// Identifies the triangles of a mesh.
struct MeshKey {
  ArrayKey positions, triangles;

  explicit MeshKey(const Mesh& mesh) : positions(mesh.positions), triangles(mesh.triangles) {}
  bool operator==(const MeshKey&) const = default;

  struct Hash {
    std::size_t operator()(const MeshKey& key) const {
      const ArrayKey::Hash hash;
      return hash(key.positions) * 31 + hash(key.triangles);
    }
  };
};

class SharedMeshes {
 public:
  /// Returns false if the mesh is placed and has the arrays of a placed mesh that was added before.
  bool add(const Mesh& mesh) { return find_or_add(mesh).is_new; }

  struct Known {
    const Mesh& mesh;  ///< the first mesh with the same arrays
    bool is_new;       ///< as add() returns
  };
  Known find_or_add(const Mesh& mesh) {
    if (!mesh.placement) return {mesh, true};
    const auto [known, is_new] = meshes_.emplace(MeshKey(mesh), &mesh);
    if (is_new || !has_same_arrays(*known->second, mesh)) return {mesh, true};
    return {*known->second, false};
  }

 private:
  static bool has_same_arrays(const Mesh& a, const Mesh& b) {
    const auto is_same = [](const auto& x, const auto& y) { return ArrayKey(x) == ArrayKey(y); };
    if (a.uv_sets.size() != b.uv_sets.size()) return false;
    for (std::size_t i = 0; i < a.uv_sets.size(); ++i)
      if (!is_same(a.uv_sets[i], b.uv_sets[i])) return false;
    return is_same(a.positions, b.positions) && is_same(a.triangles, b.triangles) &&
           is_same(a.normals, b.normals) && is_same(a.tangents, b.tangents) &&
           is_same(a.colors, b.colors) && is_same(a.segments, b.segments);
  }

  std::unordered_map<MeshKey, const Mesh*, MeshKey::Hash> meshes_;
};

}  // namespace microtrace
