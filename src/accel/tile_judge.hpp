#pragma once
/// The stages behind the float32 tile kernel: Judge for many rays with one origin.

#include "accel/bundle.hpp"
#include "accel/kernels/kernel.hpp"
#include "accel/slow_path.hpp"

#include <optional>
#include <span>

namespace microtrace {

class TileJudge {
 public:
  /// For rays that make a bundle. Both must outlive the judge.
  TileJudge(const Primitives& primitives, std::span<const Ray> rays)
      : primitives_(&primitives), rays_(rays) {}

  /// Starts the tile with the hits of these primitives.
  void begin(KernelTile& tile, std::span<const PrimitiveId> ids);

  /// For kernels; the judge must outlive it.
  [[nodiscard]] TileSlowPath slow_path();

 private:
  void consider_all(std::uint32_t id, KernelTile& tile);
  Bundle& bundle();

  const Primitives* primitives_;
  std::span<const Ray> rays_;
  std::optional<Bundle> bundle_;  // made on first need: most tiles meet triangles only
};

}  // namespace microtrace
