#pragma once
/// The distribution of ggx.hpp stretched along one direction (E. Heitz, Understanding the
/// masking-shadowing function, 2014, section 5.4), with the same member functions.

#include "render/bsdf/ggx.hpp"

#include <microtrace/math.hpp>

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace microtrace::bsdf {

class AnisotropicGgxAlbedo;

class AnisotropicGgx {
 public:
  using DirectionalAlbedo = AnisotropicGgxAlbedo;

  /// As in KHR_materials_anisotropy: the unit vector `along` is the direction of the rougher alpha,
  /// which strength interpolates from that of the roughness to 1.
  AnisotropicGgx(float roughness, float strength, const Vec2& along)
      : along_(along), across_alpha_(Ggx(roughness).alpha()) {
    alpha_ = across_alpha_ + (1 - across_alpha_) * strength * strength;
  }

  [[nodiscard]] float distribution(const Vec3& h) const {
    const Vec3 v = turned(h);
    const float x = v.x / alpha_, y = v.y / across_alpha_;
    const float q = x * x + y * y + v.z * v.z;
    return kInversePi / (alpha_ * across_alpha_ * q * q);
  }

  [[nodiscard]] float root(const Vec3& w) const {
    const Vec3 v = turned(w);
    const float x = v.x * alpha_, y = v.y * across_alpha_;
    return std::sqrt(x * x + y * y + v.z * v.z);
  }

  [[nodiscard]] float visibility(const Vec3& wo, const Vec3& wi) const {
    return 0.5F / (wi.z * root(wo) + wo.z * root(wi));
  }

  [[nodiscard]] float reflected_pdf(const Vec3& wo, float distribution) const {
    return distribution / (2 * (wo.z + root(wo)));
  }

  [[nodiscard]] Vec3 visible_normal(const Vec3& wo, const Vec2& u) const {
    const Vec3 h = bsdf::visible_normal(alpha_, across_alpha_, turned(wo), u);
    return {along_.x * h.x - along_.y * h.y, along_.y * h.x + along_.x * h.y, h.z};
  }

  /// The alpha along the direction, across it, and at the azimuth of w.
  [[nodiscard]] float along_alpha() const { return alpha_; }
  [[nodiscard]] float across_alpha() const { return across_alpha_; }
  [[nodiscard]] float alpha(const Vec3& w) const {
    const Vec3 v = turned(w);
    const float x = v.x * alpha_, y = v.y * across_alpha_, square = v.x * v.x + v.y * v.y;
    return square > 0 ? std::sqrt((x * x + y * y) / square) : alpha_;
  }

 private:
  /// Rotated to coordinates whose x axis is the direction.
  [[nodiscard]] Vec3 turned(const Vec3& v) const {
    return {along_.x * v.x + along_.y * v.y, along_.x * v.y - along_.y * v.x, v.z};
  }

  Vec2 along_;
  float alpha_, across_alpha_;
};

}  // namespace microtrace::bsdf
