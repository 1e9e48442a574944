#pragma once
/// Composites the surfaces along a ray, each over the surfaces behind it (T. Porter and T. Duff,
/// Compositing digital images, 1984).

#include "render/shading/surfaces.hpp"

#include <microtrace/integrator.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

namespace microtrace {

/// The hits at the current depth. They are collected so that a surface counts only once if several
/// of its triangles share the hit point.
class Depth {
 public:
  Depth(const World& world, const Ray& ray) : surfaces_(world.surfaces), ray_(ray) {}

  /// True if no hit at this depth is on the same surface. Hits must be passed in order.
  bool is_new(const Hit& hit) {
    if (count_ > 0 && hits_[0].t != hit.t) count_ = 0;
    const auto known = std::span(hits_).first(count_);
    const bool result = std::ranges::none_of(
        known, [&](const Hit& other) { return surfaces_.is_same_point(ray_, other, hit); });
    if (count_ < hits_.size()) hits_[count_++] = hit;
    return result;
  }

 private:
  const Surfaces& surfaces_;
  const Ray& ray_;
  std::array<Hit, 16> hits_;
  std::size_t count_ = 0;
};

class Compositing {
 public:
  /// Both arguments must outlive this object.
  Compositing(const World& world, const Ray& ray) : world_(world), ray_(ray), depth_(world, ray) {}

  /// Adds the surface at the next hit of the ray. Returns false, without effect, if an earlier hit
  /// is the same point of the same surface.
  bool add(const Hit& hit) {
    if (!depth_.is_new(hit)) return false;
    const Vec4 surface = world_.base_color(ray_, hit);
    const double alpha = surface.w;
    if (alpha > 0) color_ += through_ * alpha * DVec3(surface);
    through_ *= 1 - alpha;
    return true;
  }

  /// The transparency of the surfaces added so far.
  [[nodiscard]] double through() const { return through_; }
  /// True if surfaces further behind could not change a float32.
  [[nodiscard]] bool is_opaque() const { return through_ < kLeastLight; }
  [[nodiscard]] Sample sample() const {
    return {.color = Vec3(color_), .alpha = static_cast<float>(1 - through_)};
  }

 private:
  static constexpr double kLeastLight = 0x1p-25;

  const World& world_;
  const Ray& ray_;
  Depth depth_;
  DVec3 color_{0};
  double through_ = 1;
};

}  // namespace microtrace
