#pragma once
/// The stages after the float32 packet kernel: Judge for many rays with a common origin.

#include "accel/bundle.hpp"
#include "accel/kernels/kernel.hpp"
#include "accel/slow_path.hpp"

#include <optional>
#include <span>

namespace microtrace {

class TileJudge {
 public:
  /// The rays must have a common origin. Both arguments must outlive this object.
  TileJudge(const Primitives& primitives, std::span<const Ray> rays)
      : primitives_(&primitives), rays_(rays) {}

  /// Initializes the packet with the hits of these primitives.
  void begin(KernelTile& tile, std::span<const PrimitiveId> ids);

  /// For kernels; this object must outlive the result.
  [[nodiscard]] TileSlowPath slow_path();

 private:
  void consider_all(std::uint32_t id, KernelTile& tile);
  Bundle& bundle();

  const Primitives* primitives_;
  std::span<const Ray> rays_;
  std::optional<Bundle> bundle_;  // created when first needed: most packets only need triangles
};

}  // namespace microtrace
