#pragma once
/// The members of a Bvh, and queries of single rays and packets.

#include "accel/build/tree.hpp"
#include "accel/bvh_tree.hpp"
#include "accel/few_triangles.hpp"
#include "accel/instances/dispatch.hpp"
#include "accel/kernels/kernel.hpp"
#include "accel/large_triangles.hpp"
#include "accel/ray_stream.hpp"
#include "accel/spawn/kernels/kernel.hpp"
#include "accel/spawn/shape_spawn.hpp"

#include <microtrace/bvh.hpp>

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace microtrace {

struct Bvh::Impl {
  Impl(const Scene& scene, BvhOptions options);

  [[nodiscard]] TreeView view() const {
    return {.nodes = tree.nodes.data(),
            .blocks = tree.blocks.data(),
            .others = tree.others.data(),
            .root = tree.root,
            .instances = tree.instances.empty() ? nullptr : tree.instances.data(),
            .meshes = tree.views.data(),
            .scene_block = instance_kernels->scene_block};
  }
  /// The tree for arrays of rays and for queries near origins, of which `few` or `large` are tested
  /// without traversal.
  [[nodiscard]] TreeView view_without_few() const {
    TreeView result = view();
    if (large.triangles) {
      result.nodes = large.rest.data();
      result.rest = large.bounds;
    }
    result.few = large.triangles ? large.triangles.get() : few.get();
    result.few_are_all = large.triangles == nullptr;
    return result;
  }

  [[nodiscard]] RayStream::Target stream_target() const {
    return {.primitives = primitives,
            .unbounded = unbounded,
            .kernels = *kernels,
            .tree = view_without_few(),
            .duplicates = tree.duplicates};
  }
  [[nodiscard]] SpawnBatch make_spawns() const {
    return {primitives, unbounded, *kernels, *spawn_kernels,
            has_tree ? std::optional(view_without_few()) : std::nullopt};
  }

  [[nodiscard]] std::optional<Hit> intersect(const Ray& ray) const;
  [[nodiscard]] std::optional<Hit> next(const Ray& ray, PrimitiveId after) const;
  [[nodiscard]] bool occluded(const Ray& ray) const;
  [[nodiscard]] std::optional<Vec3> search_origin(const Spawn& spawn) const;

  /// Set hits[i] to the first hit of ray i that is not on an open side. For `left`, see
  /// Bvh::intersect.
  void intersect(std::span<const Ray> rays, std::span<const PrimitiveId> left, const OpenSide& open,
                 std::span<std::optional<Hit>> hits) const;
  /// The first hit of a ray with a primitive for which passes(id) is false.
  template <class Passes>
  [[nodiscard]] std::optional<Hit> intersect(const Ray& ray, const Passes& passes) const {
    std::optional<Hit> hit = intersect(ray);
    while (hit && passes(hit->id)) hit = next(ray, hit->id);
    return hit;
  }
  /// False if triangles coincide. One in the tree then stands for all, but they may have different
  /// sides.
  [[nodiscard]] bool knows_sides() const { return tree.duplicates.empty(); }
  /// The backs of these triangles, or of none if sides aren't known.
  [[nodiscard]] OpenSide open_backs(BitPages triangles) const {
    return {.triangles = knows_sides() ? triangles : nullptr, .is_back = true};
  }
  /// Traces up to kPacketRays rays with a common origin. Returns false, without effect, if one of
  /// the rays exceeds the kernels' limits.
  [[nodiscard]] bool intersect_packet(std::span<const Ray> rays, const OpenSide& open,
                                      std::span<std::optional<Hit>> hits) const;

  Primitives primitives;
  std::shared_ptr<const BvhTree> shared;
  const Tree& tree = shared->tree;
  const std::vector<PrimitiveId>& unbounded = tree.unbounded;  // tested one by one
  bool has_tree = tree.has_leaves();
  std::unique_ptr<const FewTriangles> few = few_triangles(tree);
  LargeTriangles large = few ? LargeTriangles{} : large_triangles(tree);
  const Kernels* kernels;
  const SpawnKernels* spawn_kernels;
  const InstanceKernels* instance_kernels;
};

}  // namespace microtrace
