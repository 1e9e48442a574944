#pragma once
/// Arrays of unrelated rays, asked of the stream kernels.

#include "accel/kernels/kernel.hpp"

#include <microtrace/primitives.hpp>
#include <microtrace/ray.hpp>

#include <array>
#include <memory>
#include <optional>
#include <span>

namespace microtrace {

/// Collects rays and traces them in batches. The answers are there once `flush` has returned.
class RayStream {
 public:
  /// What stands for the scene; all of it must outlive the stream.
  struct Target {
    const Primitives& primitives;
    std::span<const PrimitiveId> outside;  ///< of the tree: asked one by one
    const Kernels& kernels;
    TreeView tree;
  };
  explicit RayStream(const Target& target);

  /// The ray must suit kernels; the ray itself is copied.
  void add(const Ray& ray, std::size_t place);
  [[nodiscard]] bool is_full() const { return rays_->stream.count == kStreamRays; }

  /// Answers all rays added since: hits[place] for each.
  void flush_closest(std::span<std::optional<Hit>> hits);
  void flush_any(std::span<bool> results);

 private:
  struct Rays {
    KernelStream stream;
    std::array<Ray, kStreamRays> rays;
    std::array<std::size_t, kStreamRays> places;
  };

  void ask_outside();
  [[nodiscard]] StreamSlowPath slow_path();

  Target target_;
  std::unique_ptr<Rays> rays_;
};

}  // namespace microtrace
