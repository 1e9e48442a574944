#pragma once
/// The distribution of ggx.hpp, stretched along one direction (E. Heitz, Understanding the
/// masking-shadowing function, 2014, section 5.4). The class has the same member functions as Ggx.

#include "render/bsdf/ggx.hpp"

namespace microtrace::bsdf {

template <int N>
class AnisotropicGgx {
 public:
  using F = Float<N>;
  using V = Floats3<N>;

  /// Parameters are those of KHR_materials_anisotropy. The unit vector `along` is the direction of
  /// the larger alpha. This alpha increases with `strength` from the roughness's alpha to 1.
  AnisotropicGgx(const F& roughness, const F& strength, const Floats2<N>& along)
      : along_(along), across_alpha_(Ggx<N>(roughness).alpha()) {
    alpha_ = across_alpha_ + (1 - across_alpha_) * strength * strength;
  }

  [[nodiscard]] F distribution(const V& h) const {
    const V v = turned(h);
    const F x = v.x / alpha_, y = v.y / across_alpha_;
    const F q = x * x + y * y + v.z * v.z;
    return kInversePi / (alpha_ * across_alpha_ * q * q);
  }

  [[nodiscard]] F root(const V& w) const {
    const V v = turned(w);
    const F x = v.x * alpha_, y = v.y * across_alpha_;
    return square_root<N>(x * x + y * y + v.z * v.z);
  }

  [[nodiscard]] F visibility(const V& wo, const V& wi) const {
    return 0.5F / (wi.z * root(wo) + wo.z * root(wi));
  }

  /// KHR_materials_anisotropy gives the height-correlated term, unlike glTF's section B.3.2.
  [[nodiscard]] F spec_visibility(const V& wo, const V& wi) const { return visibility(wo, wi); }

  [[nodiscard]] F reflected_pdf(const V& wo, const F& distribution) const {
    return distribution / (2 * (wo.z + root(wo)));
  }

  [[nodiscard]] V visible_normal(const V& wo, const Floats2<N>& u) const {
    const V h = bsdf::visible_normal<N>(alpha_, across_alpha_, turned(wo), u);
    return {along_.x * h.x - along_.y * h.y, along_.y * h.x + along_.x * h.y, h.z};
  }

  /// The alpha along the direction `along`, perpendicular to it, and at the azimuth of w.
  [[nodiscard]] const F& along_alpha() const { return alpha_; }
  [[nodiscard]] const F& across_alpha() const { return across_alpha_; }
  [[nodiscard]] F alpha(const V& w) const {
    const V v = turned(w);
    const F x = v.x * alpha_, y = v.y * across_alpha_, square = v.x * v.x + v.y * v.y;
    return square > 0 ? square_root<N>((x * x + y * y) / square) : alpha_;
  }

 private:
  /// Transforms a vector to coordinates whose x axis is `along`.
  [[nodiscard]] V turned(const V& v) const {
    return {along_.x * v.x + along_.y * v.y, along_.x * v.y - along_.y * v.x, v.z};
  }

  Floats2<N> along_;
  F alpha_, across_alpha_;
};

}  // namespace microtrace::bsdf
