#pragma once
/// bsdf::Bsdf for N lanes: metallic-roughness without film or transmission. Same local coordinates.

#include "render/kernels/ggx_lanes.hpp"
#include "render/kernels/kernel.hpp"
#include "render/kernels/vector3.hpp"

namespace microtrace {
namespace {

template <int N>
inline Float<N> luminance_of(const Vector3<Float<N>>& c) {
  return 0.2126F * c.x + 0.7152F * c.y + 0.0722F * c.z;
}

/// bsdf::Frame for N lanes.
template <int N>
struct FrameLanes {
  using F = Float<N>;
  using V = Vector3<F>;

  V s, t, n;

  explicit FrameLanes(const V& normal) : n(normal) {
    const F sign = with_sign_of<N>(all<N>(1), n.z);
    const F a = -1 / (sign + n.z), b = n.x * n.y * a;
    s = {1 + sign * n.x * n.x * a, sign * b, -sign * n.x};
    t = {b, sign + n.y * n.y * a, -n.y};
  }
  [[nodiscard]] V to_local(const V& v) const { return {dot(v, s), dot(v, t), dot(v, n)}; }
  [[nodiscard]] V to_world(const V& v) const { return v.x * s + v.y * t + v.z * n; }
};

template <int N>
struct EvaluationLanes {
  Vector3<Float<N>> value;
  Float<N> pdf;
};

template <int N>
class BsdfLanes {
 public:
  using F = Float<N>;
  using V = Vector3<F>;

  BsdfLanes(const ScatterSetup& setup, const ScatterLanes& lanes, int i, const V& wo)
      : wo_(wo),
        ggx_(load<N>(lanes.roughness + i)),
        albedo_(setup, ggx_),
        f0_(load3<N>(lanes.f0, i)),
        f90_(load<N>(lanes.f90 + i)) {
    const V base = load3<N>(lanes.base_color, i);
    const F metallic = load<N>(lanes.metallic + i);
    greatest_f0_ = larger_of(larger_of(f0_.x, f0_.y), f0_.z);
    greatest_f90_ = f90_;
    f0_ = f0_ + metallic * (base - f0_);
    f90_ = f90_ + metallic * (1 - f90_);
    const AlbedoLanes<N> mean = albedo_.mean(), there = albedo_.at(wo.z);
    multiply_reflected_ = multiple_scattering(greatest_f0_, greatest_f90_, mean.f1);
    const F several = kInversePiLanes / larger_of(1 - mean.f1, all<N>(1e-6F)) * (1 - there.f1);
    multiple_ = {multiple_scattering(f0_.x, f90_, mean.f1) * several,
                 multiple_scattering(f0_.y, f90_, mean.f1) * several,
                 multiple_scattering(f0_.z, f90_, mean.f1) * several};
    const F dielectric = 1 - metallic;
    const F mean_left = larger_of(unreflected(mean), all<N>(1e-6F));
    diffuse_ = dielectric * kInversePiLanes * unreflected(there) / mean_left * base;
    const F facets = luminance_of<N>((there.f1 - there.schlick) * f0_) + f90_ * there.schlick;
    const F spread =
        (luminance_of<N>(diffuse_) * mean_left + luminance_of<N>(multiple_) * (1 - mean.f1)) /
        kInversePiLanes;
    const F share = facets / (facets + spread);
    const F clamped = share < 0.1F ? all<N>(0.1F) : 0.9F < share ? all<N>(0.9F) : share;
    facet_probability_ = spread > 0.01F ? clamped : all<N>(1);
  }

  /// For wi above the surface.
  [[nodiscard]] EvaluationLanes<N> above(const V& wi, const V& h) const {
    const F cosine = smaller_of(dot(wo_, h), all<N>(1));
    const F d = ggx_.distribution(h);
    const AlbedoLanes<N> there = albedo_.at(wi.z);
    const F x = 1 - cosine, square = x * x, edge = square * square * x;
    const V reflectance = f0_ + edge * (f90_ - f0_);
    const V f = d * ggx_.visibility(wo_.z, wi.z) * reflectance + unreflected(there) * diffuse_ +
                (1 - there.f1) * multiple_;
    return {wi.z * f, facet_probability_ * ggx_.reflected_pdf(wo_.z, d) +
                          (1 - facet_probability_) * kInversePiLanes * wi.z};
  }

  struct Direction {
    V wi, h;  ///< no sample if wi is below the surface
  };
  [[nodiscard]] Direction sample(const F& ux, const F& uy, const F& lobe) const {
    const V facet = ggx_.visible_normal(wo_, ux, uy);
    const V reflected = 2 * smaller_of(dot(wo_, facet), all<N>(1)) * facet - wo_;
    const auto [cosine, sine] = unit_pair<N>(ux);
    const F r = square_root<N>(uy);
    const V spread{r * cosine, r * sine, square_root<N>(1 - uy)};
    const auto is_facet = lobe < facet_probability_;
    return {select3(is_facet, reflected, spread), select3(is_facet, facet, unit<N>(wo_ + spread))};
  }

 private:
  static F multiple_scattering(const F& f0, const F& f90, const F& mean) {
    const F fresnel = f0 + (f90 - f0) * (1 / 21.0F);
    return fresnel * fresnel * mean / (1 - fresnel * (1 - mean));
  }
  [[nodiscard]] F unreflected(const AlbedoLanes<N>& a) const {
    return 1 - (greatest_f0_ * (a.f1 - a.schlick) + greatest_f90_ * a.schlick) -
           multiply_reflected_ * (1 - a.f1);
  }

  V wo_;
  GgxLanes<N> ggx_;
  GgxAlbedoLanes<N> albedo_;
  V f0_;
  F f90_, greatest_f0_, greatest_f90_, multiply_reflected_;
  V diffuse_, multiple_;
  F facet_probability_;
};

}  // namespace
}  // namespace microtrace
