#pragma once
/// The BSDF of surfaces that reflect only diffusely, for N lanes.

#include "render/bsdf/bsdf.hpp"

namespace microtrace::bsdf {

template <int N>
struct MatteParts {
  using FeaturesType = PlainFeatures;
};

/// Lambertian reflection. For surfaces that are_matte(), the results have the same bits as those of
/// PlainParts, so other lanes may decide which of the two is evaluated.
template <int N>
class Bsdf<N, MatteParts<N>> {
 public:
  using F = Float<N>;
  using V = Floats3<N>;

  struct Sample {
    V wi;
    Evaluation<N> evaluation;
  };

  Bsdf(const PlainFeatures& /*features*/, const Surface<N>& surface, const Coating<N>* /*coating*/,
       const V& /*wo*/)
      : diffuse_(kInversePi * surface.base_color) {}

  [[nodiscard]] Evaluation<N> evaluate(const V& wi) const {
    const auto is_above = wi.z > 0;
    return {select3(is_above, V(diffuse_ * wi.z), all3<N>(0)), is_above ? kInversePi * wi.z : F{}};
  }
  [[nodiscard]] Sample sample(const Floats2<N>& u, const F& /*lobe*/) const {
    const V wi = sampling::cosine_hemisphere<N>(u);
    return {wi, evaluate(wi)};
  }

 private:
  V diffuse_;
};

/// True if these N surfaces, which have no Features, have no specular reflection.
template <int N>
bool are_matte(const SurfaceLanes& lanes, int i) {
  const Surface<N> s = Surface<N>::plain(lanes, i);
  return are_all(is_zero(s.dielectric.f0) & (s.dielectric.f90 == 0) & (s.metallic == 0));
}

}  // namespace microtrace::bsdf
