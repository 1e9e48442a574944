#pragma once
/// Finds the first visible surfaces of rays, and computes exact quantities there.

#include "scene/kernels/kernel.hpp"

#include <microtrace/aov.hpp>
#include <microtrace/hit.hpp>
#include <microtrace/integrator.hpp>
#include <microtrace/ray.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>

namespace microtrace {

/// The set of quantities to compute.
class AovSet {
 public:
  AovSet() = default;
  AovSet(std::initializer_list<Aov> aovs) {
    for (const Aov aov : aovs) add(aov);
  }

  void add(Aov aov) { bits_ |= bit(aov); }
  [[nodiscard]] bool has(Aov aov) const { return (bits_ & bit(aov)) != 0; }
  /// True if any quantity needs the surface at the hit, not only the hit.
  [[nodiscard]] bool needs_surfaces() const {
    return (bits_ & ~(bit(Aov::id) | bit(Aov::albedo))) != 0;
  }

 private:
  static unsigned bit(Aov aov) { return 1U << static_cast<unsigned>(aov); }
  unsigned bits_ = 0;
};

/// The value of a quantity where nothing is visible.
[[nodiscard]] inline float value_of_nothing(Aov aov) {
  const bool is_length = aov == Aov::depth || aov == Aov::distance;
  return is_length ? std::numeric_limits<float>::infinity() : 0;
}

/// The first visible surfaces, as defined by Aov, of up to kRegularBatch rays.
class Sights {
 public:
  static constexpr std::size_t kSize = kRegularBatch;
  template <class T>
  using Values = std::array<std::array<T, kSize>, 3>;  ///< indexed by channel and ray

  /// The rays must outlive this object.
  Sights(const World& world, std::span<const Ray> rays, const AovSet& aovs);

  /// True if no ray hits anything visible. All values are then value_of_nothing().
  [[nodiscard]] bool is_empty() const { return seen_ == 0; }
  /// False if the ray hits nothing that is visible.
  [[nodiscard]] bool is_seen(std::size_t ray) const { return (seen_ >> ray & 1U) != 0; }

  /// Computes the values of a quantity other than id. The quantity must be in the set.
  void values_of(Aov aov, Values<float>& values) const;

  /// Computes the ids of instances (channel 0), primitives (1) or materials (2).
  void ids(std::size_t channel, std::array<std::uint32_t, kSize>& values) const;

 private:
  [[nodiscard]] bool is_all_seen() const {
    return seen_ == ~std::uint64_t{0} >> (kSize - rays_.size());
  }

  const World& world_;
  std::span<const Ray> rays_;
  std::uint64_t seen_ = 0;  // one bit per ray
  std::array<std::optional<Hit>, kSize> hits_;
  SurfaceBatch surfaces_;
};

}  // namespace microtrace
