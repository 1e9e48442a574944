#pragma once
/// The stages behind the float32 tile kernel: Judge for many rays with one origin.

#include "accel/bundle.hpp"
#include "accel/kernels/kernel.hpp"
#include "accel/slow_path.hpp"

#include <span>

namespace microtrace {

class TileJudge {
 public:
  /// All must outlive the judge. The bundle is of the same rays; what it has met counts already.
  TileJudge(const Primitives& primitives, const Bundle& bundle, std::span<const Ray> rays)
      : primitives_(&primitives), bundle_(&bundle), rays_(rays) {}

  /// Starts the tile from the bundle's hits.
  void fill_best(KernelTile& tile) const;

  /// What the kernel found for ray i, t rounded once.
  [[nodiscard]] std::optional<Hit> hit(const KernelTile& tile, std::size_t i) const;

  /// For kernels; the judge must outlive it.
  [[nodiscard]] TileSlowPath slow_path();

 private:
  void consider_all(std::uint32_t id, KernelTile& tile) const;

  const Primitives* primitives_;
  const Bundle* bundle_;
  std::span<const Ray> rays_;
};

}  // namespace microtrace
