#pragma once
/// Rays in the space of an instance's mesh, for tests that must not miss a triangle of the
/// instance. Triangles that pass are transformed to the scene, where the kernels test them again.
///
/// Let A be the matrix of the placement, t its translation, B = A^-1, o + s d the ray, and q a
/// point where it hits a triangle of the instance at s >= 0. The triangle's vertices are A v + t,
/// rounded with errors of at most e_j. So q = A p + t + e for a point p of the mesh's triangle, and
/// p = B (o - t) + s B d - B e. Let r_i be the greatest |B_ij| of row i. The stored inverse has
/// errors below 1.1 u r_i (`make_instance` checks it). With c = fl(o - t) and C = sum |c_j|, the
/// computed o' = B c differs from the exact one by at most 5.2 u r_i C: 1.1 u from B, u from c, and
/// 3 u from the products and sums. The computed d' = B d differs by at most 4.2 u r_i sum |d_j|,
/// and s |d_j| = |q_j - o_j| is at most |c_j| plus the greatest distance of the instance's box from
/// t along axis j, whose sum is rho. So the point o' + s d' of the computed ray differs from p by
/// at most h_i = r_i (9.4 u C + 4.2 u rho + sum e_j), where 13 u C also covers the rounding of
/// o' +- h, and Instance::reach is an upper bound of the rest.
///
/// - A box that contains p is entered by the ray if the box is enlarged by h_i on each side, or if
///   the origins for the planes of entry and exit are moved by h_i.
/// - The ray hits the mesh's triangle moved by a vector within +- h. Such a move changes the vector
///   A of docs/exactness.md from the origin to the first vertex, but no edge. It changes the edge
///   functions by at most 2 em d_sum sum h_i and the height by at most 2 m sum h_i. Adding
///   sum h_i / (4 u) to a_sum in the error bounds of VolumeTest covers both.

#include "accel/kernels/slabs.hpp"

namespace microtrace {
namespace {

struct InnerRay {
  float o[3], d[3], d_sum;
  float slack;  ///< to be added to the sum of |components| of the vector from the origin
  BoxRay box;
};

/// The coordinates of a direction in the mesh's space are at most this large. Then no float32
/// result of the tests overflows.
constexpr float kLongestInnerDirection = 0x1p37F;

/// Returns r_i for a row of the stored inverse, rounded up.
inline float row_max(const float (&row)[3]) {
  return greater(greater(__builtin_fabsf(row[0]), __builtin_fabsf(row[1])),
                 __builtin_fabsf(row[2])) *
         (1 + 0x1p-20F);
}

/// The origin of rays inside an instance, and the displacements h_i.
struct InnerOrigin {
  float o[3], reach[3];

  InnerOrigin(const Instance& instance, const float (&scene_o)[3]) {
    float c[3], distance = 0;
    for (int j = 0; j < 3; ++j) {
      c[j] = static_cast<float>(double{scene_o[j]} - instance.scene_from_mesh[9 + j]);
      distance += __builtin_fabsf(c[j]);
    }
    const float sum = distance * (13 * 0x1p-24F) + instance.reach;
    for (int i = 0; i < 3; ++i) {
      const float(&row)[3] = instance.mesh_from_scene[i];
      o[i] = row[0] * c[0] + row[1] * c[1] + row[2] * c[2];
      reach[i] = row_max(row) * sum;
    }
  }
};

/// Sets the ray inside an instance. Returns false if it exceeds the limits.
inline bool enter(const Instance& instance, const KernelRay& ray, InnerRay& inner) {
  const InnerOrigin origin(instance, ray.o);
  float sum = 0;
  bool suits = true;
  for (int i = 0; i < 3; ++i) {
    const float(&row)[3] = instance.mesh_from_scene[i];
    inner.o[i] = origin.o[i];
    inner.d[i] = row[0] * ray.d[0] + row[1] * ray.d[1] + row[2] * ray.d[2];
    const float h = origin.reach[i];
    sum += h;
    const float moved = inner.d[i] < 0 ? -h : h;
    inner.box.near_o[i] = inner.o[i] + moved;
    inner.box.far_o[i] = inner.o[i] - moved;
    suits &= __builtin_fabsf(inner.o[i]) <= kFarthestCoordinate &&
             __builtin_fabsf(inner.d[i]) <= kLongestInnerDirection;
  }
  inner.slack = sum * 0x1p22F;
  inner.d_sum = set_direction(inner.d, inner.box);
  return suits;
}

/// The tree that a ray or a query traverses: the scene's, or that of an instance's mesh.
struct Scope {
  const WideNode* nodes;
  const TriangleBlock* blocks;
  const std::uint32_t* others;
  const Instance* instance;  ///< null for the scene's tree

  Scope() = default;
  explicit Scope(const TreeView& tree)
      : nodes(tree.nodes), blocks(tree.blocks), others(tree.others), instance(nullptr) {}
  Scope(const MeshTree& mesh, const Instance& entered)
      : nodes(mesh.nodes), blocks(mesh.blocks), others(mesh.others), instance(&entered) {}

  /// Returns what belongs to the scope: `inner` in an instance, otherwise `outer`.
  template <class T>
  [[nodiscard]] const T& choose(const T& outer, const T& inner) const {
    return instance == nullptr ? outer : inner;
  }
  [[nodiscard]] std::uint32_t first_id() const {
    return instance != nullptr ? instance->first_id : 0;
  }
};

inline bool is_instance(ChildRef child) {
  return child >= child_ref::kFirstInstance && child <= child_ref::kLastInstance;
}

}  // namespace
}  // namespace microtrace
