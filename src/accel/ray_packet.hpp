#pragma once
/// Tests primitives against several rays with a common origin, and keeps the nearest hit of each
/// ray.

#include "accel/filters/shape_filter.hpp"
#include "accel/resolve/closest_hit.hpp"
#include "accel/resolve/hit_resolver.hpp"

#include <microtrace/primitives.hpp>

#include <array>
#include <cstddef>
#include <optional>
#include <span>

namespace microtrace {

class RayPacket {
 public:
  static constexpr std::size_t kCapacity = kPacketRays;

  /// `rays` must be 1 to kCapacity valid rays with the same origin. Both arguments must outlive
  /// this object.
  RayPacket(const Primitives& primitives, std::span<const Ray> rays)
      : primitives_(&primitives), rays_(rays) {
    filterable_ = is_filterable(rays[0].o);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      filterable_ &= is_filterable(rays[i].d);
      directions_[i] = rays[i].d;
      ranges_[i] = {.t_min = rays[i].t_min, .t_max = rays[i].t_max};
    }
  }

  /// Tests one primitive against all rays. Primitives may be tested in any order, each at most
  /// once.
  template <class AnyShape>
  void test(PrimitiveId id, const AnyShape& shape) {
    for_each_result(shape, [&](std::size_t i, const FilterResult& filtered) {
      closest_[i].consider(id, filtered, ExactHits(*primitives_, rays_[i]));
    });
  }

  /// Calls f(i, filtered) for every ray i with the filter's result.
  template <class AnyShape, class F>
  void for_each_result(const AnyShape& shape, const F& f) const {
    if (filterable_ && is_filterable(shape)) {
      const auto filter = seen_from(rays_[0].o, shape);
      for (std::size_t i = 0; i < rays_.size(); ++i) f(i, filter(directions_[i], ranges_[i]));
    } else {
      for (std::size_t i = 0; i < rays_.size(); ++i)
        f(i, FilterResult{.certainty = Certainty::unsure});
    }
  }

  /// Returns the nearest hit so far of ray i, in the form that kernels use.
  [[nodiscard]] ClosestSoFar best(std::size_t i) const {
    return closest_so_far(closest_[i], rays_[i]);
  }

  [[nodiscard]] std::optional<Hit> hit(std::size_t i) const {
    return closest_[i].rounded(ExactHits(*primitives_, rays_[i]));
  }

 private:
  const Primitives* primitives_;
  std::span<const Ray> rays_;
  bool filterable_ = false;
  std::array<DVec3, kCapacity> directions_;
  std::array<Range, kCapacity> ranges_;
  std::array<ClosestHit, kCapacity> closest_;
};

}  // namespace microtrace
