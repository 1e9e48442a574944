#pragma once
/// Traces arrays of incoherent rays with the stream kernels.

#include "accel/kernels/kernel.hpp"

#include <microtrace/primitives.hpp>
#include <microtrace/ray.hpp>

#include <array>
#include <optional>
#include <span>

namespace microtrace {

/// Rays in one array per component, and the primitives that they leave as in Bvh::intersect.
struct RayColumns {
  const float *o[3], *d[3], *t_max;  ///< t_min is 0
  const PrimitiveId* left;
  std::size_t count;

  [[nodiscard]] Ray operator[](std::size_t i) const {
    return {.o = {o[0][i], o[1][i], o[2][i]},
            .t_min = 0,
            .d = {d[0][i], d[1][i], d[2][i]},
            .t_max = t_max[i]};
  }
  /// The rays from `first` on.
  [[nodiscard]] RayColumns from(std::size_t first) const {
    return {.o = {o[0] + first, o[1] + first, o[2] + first},
            .d = {d[0] + first, d[1] + first, d[2] + first},
            .t_max = t_max + first,
            .left = left + first,
            .count = count - first};
  }
};

/// True if a ray that hits primitive `id` arrives at the front of one of the triangles `open`,
/// which has one bit per primitive or is null.
[[nodiscard]] bool meets_open_front(const Primitives& primitives, const std::uint32_t* open,
                                    const Ray& ray, PrimitiveId id);

/// Traces up to kStreamRays rays at a time. The caller must trace rays beyond the kernels' limits.
class RayStream {
 public:
  /// The scene to trace. All members must outlive the stream.
  struct Target {
    const Primitives& primitives;
    std::span<const PrimitiveId> outside;  ///< primitives outside of the tree
    const Kernels& kernels;
    TreeView tree;
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

  /// Sets the triangles of meshes whose fronts rays in columns pass through, one bit per primitive;
  /// null for none.
  void set_open_fronts(const std::uint32_t* triangles) { target_.tree.open_fronts = triangles; }

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
  void ask_outside();
  void find_closest(const Rays& rays, std::span<std::optional<Hit>> hits);
  void find_closest(std::span<PrimitiveId> ids);
  void find_any(std::span<bool> results);
  void find_any(std::span<PrimitiveId> ids);
  [[nodiscard]] std::size_t count() const { return static_cast<std::size_t>(stream_.count); }
  [[nodiscard]] Ray ray(std::size_t i) const { return rays_.empty() ? columns_[i] : rays_[i]; }
  [[nodiscard]] StreamFallback fallback();
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
  KernelStream stream_;
};

}  // namespace microtrace
