#pragma once
/// Traces arrays of incoherent rays with the stream kernels.

#include "accel/build/references/duplicates.hpp"
#include "accel/kernels/kernel.hpp"
#include "base/bit_set.hpp"

#include <microtrace/primitives.hpp>
#include <microtrace/ray.hpp>

#include <array>
#include <optional>
#include <span>

namespace microtrace {

class HitResolver;

/// Rays in one array per component, and the primitives that they leave as in Bvh::intersect.
struct RayColumns {
  const float *o[3], *d[3], *t_max;
  const PrimitiveId* left;
  std::size_t count;
  const float* t_min = nullptr;  ///< null for 0

  [[nodiscard]] Ray operator[](std::size_t i) const {
    return {.o = {o[0][i], o[1][i], o[2][i]},
            .t_min = t_min == nullptr ? 0 : t_min[i],
            .d = {d[0][i], d[1][i], d[2][i]},
            .t_max = t_max[i]};
  }
  /// The rays from `first` on.
  [[nodiscard]] RayColumns from(std::size_t first) const {
    return {.o = {o[0] + first, o[1] + first, o[2] + first},
            .d = {d[0] + first, d[1] + first, d[2] + first},
            .t_max = t_max + first,
            .left = left + first,
            .count = count - first,
            .t_min = t_min == nullptr ? nullptr : t_min + first};
  }
};

/// Triangles that rays pass through in some places, such as those with alpha masks.
struct MaskedTriangles {
  BitPages triangles = nullptr;
  const void* context = nullptr;
  /// What the weights alone tell about ray number i of a query, which hits primitive `id`; null
  /// if they tell nothing.
  Visible (*known)(const void* context, std::size_t i, PrimitiveId id,
                   const HitWeights& at) = nullptr;
  /// True if ray number i of a query, which hits primitive `id`, passes through it.
  bool (*passes)(const void* context, std::size_t i, const Ray& ray, PrimitiveId id) = nullptr;

  [[nodiscard]] bool lets_pass(std::size_t i, const Ray& ray, PrimitiveId id) const {
    return is_in(triangles, id) && passes(context, i, ray, id);
  }
};

/// Selects the hits that count.
struct HitFilter {
  OpenSide open{};  ///< of triangles of meshes
  MaskedTriangles masked{};
};

/// Traces up to kStreamRays rays at a time. The caller must trace rays beyond the kernels' limits.
class RayStream {
 public:
  /// The scene to trace. All members must outlive the stream.
  struct Target {
    const Primitives& primitives;
    std::span<const PrimitiveId> unbounded;  ///< primitives outside of the tree
    const Kernels& kernels;
    TreeView tree;
    const Duplicates& duplicates;  ///< of the tree
  };
  explicit RayStream(const Target& target) : target_(target) {}

  /// Rays, and the primitives that they leave or an empty span; see Bvh::intersect.
  struct Rays {
    std::span<const Ray> rays;
    std::span<const PrimitiveId> left;
  };

  /// Set hits[i] or results[i] for each ray i within the kernels' limits, and call other(i) for
  /// each other ray.
  void closest(const Rays& rays, std::span<std::optional<Hit>> hits, const auto& other) {
    find_closest(rays, hits);
    for_each_unsuited(other);
  }
  void any(const Rays& rays, std::span<bool> results, const auto& other) {
    fill(rays);
    find_any(results);
    for_each_unsuited(other);
  }

  /// Selects the hits that count in the following queries. The number of a query's first ray for
  /// HitFilter is `first`.
  void set_filter(const HitFilter& filter, std::size_t first = 0) {
    target_.tree.open = filter.open;
    target_.tree.masked = filter.masked.triangles;
    masked_ = filter.masked;
    first_ = first;
  }

  /// Do the same for rays in columns. `ids` are those of the hits, or kNoPrimitive.
  void closest(const RayColumns& rays, std::span<PrimitiveId> ids, const auto& other) {
    fill(rays);
    find_closest(ids);
    for_each_unsuited(other);
  }
  void any(const RayColumns& rays, std::span<PrimitiveId> ids, const auto& other) {
    fill(rays);
    find_any(ids);
    for_each_unsuited(other);
  }

 private:
  void fill(const Rays& rays);
  void fill(const RayColumns& rays);
  void prepare();
  void ask_unbounded();
  void find_closest(const Rays& rays, std::span<std::optional<Hit>> hits);
  void find_closest(std::span<PrimitiveId> ids);
  void find_any(std::span<bool> results);
  void find_any(std::span<PrimitiveId> ids);
  [[nodiscard]] std::size_t count() const { return static_cast<std::size_t>(stream_.count); }
  [[nodiscard]] Ray ray(std::size_t i) const { return rays_.empty() ? columns_[i] : rays_[i]; }
  [[nodiscard]] StreamFallback fallback();
  void consider(std::size_t i, PrimitiveId id, ClosestSoFar& best) const;
  /// The same for a ray that is suited. `resolver` must be made for it.
  void consider(std::size_t i, const Ray& own, const HitResolver& resolver, PrimitiveId id,
                ClosestSoFar& best) const;
  [[nodiscard]] Visible visible(std::size_t i, PrimitiveId id, const HitWeights& at) const;
  [[nodiscard]] bool is_suited(std::size_t i) const {
    return (stream_.suited[i / 64] >> i % 64 & 1U) != 0;
  }
  void for_each_unsuited(const auto& f) const {
    for (std::size_t i = 0; i < count(); ++i) {
      if (i % 64 == 0 && stream_.suited[i / 64] == ~std::uint64_t{0})
        i += 63;
      else if (!is_suited(i))
        f(i);
    }
  }

  Target target_;
  std::span<const Ray> rays_;  // empty if the rays are in columns_
  RayColumns columns_{};
  MaskedTriangles masked_{};
  std::size_t first_ = 0;
  KernelStream stream_;
};

}  // namespace microtrace
