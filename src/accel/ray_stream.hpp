#pragma once
/// Traces arrays of incoherent rays with the stream kernels.

#include "accel/kernels/kernel.hpp"

#include <microtrace/primitives.hpp>
#include <microtrace/ray.hpp>

#include <array>
#include <optional>
#include <span>

namespace microtrace {

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
    find_any(rays, results);
    for_each_unsuited(other);
  }

 private:
  void fill(const Rays& rays);
  void ask_outside();
  void find_closest(const Rays& rays, std::span<std::optional<Hit>> hits);
  void find_any(const Rays& rays, std::span<bool> results);
  [[nodiscard]] StreamFallback fallback();
  [[nodiscard]] bool is_suited(std::size_t i) const {
    return (stream_.suited[i / 64] >> i % 64 & 1U) != 0;
  }
  void for_each_unsuited(const auto& f) const {
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      if (i % 64 == 0 && stream_.suited[i / 64] == ~std::uint64_t{0})
        i += 63;
      else if (!is_suited(i))
        f(i);
    }
  }

  Target target_;
  std::span<const Ray> rays_;
  KernelStream stream_;
};

}  // namespace microtrace
