#pragma once
/// Computes direct light and samples the next direction.

#include "render/bsdf/bsdf.hpp"
#include "render/bsdf/matte_bsdf.hpp"
#include "render/kernels/survival.hpp"
#include "render/lanes/shading_kernels.hpp"
#include "render/lights/power_heuristic.hpp"
#include "render/sampling/random_pairs.hpp"

namespace microtrace {

/// The N path vertices that start at lane i, on surfaces of one kind.
template <int N, class Parts>
class Vertices {
 public:
  using F = Float<N>;
  using V = Floats3<N>;
  using FeaturesType = typename Parts::FeaturesType;

  Vertices(const FeaturesType& features, ScatterLanes& lanes, int i)
      : features_(features),
        lanes_(lanes),
        i_(i),
        frame_(bsdf::Frame<N>::about(load3<N>(lanes.frame_n, i))),
        outwards_(load3<N>(lanes.outwards, i)),
        throughput_(load3<N>(lanes.throughput, i)) {}

  void scatter(const ScatterSetup& setup) {
    const bsdf::Surface<N> surface = load_surface();
    if (features_.layers == bsdf::LayerSide::none) {
      scatter(setup, surface, nullptr);
    } else {
      const bsdf::Coating<N> coating(surface);
      scatter(setup, surface, &coating);
    }
  }

 private:
  using Bsdf = bsdf::Bsdf<N, Parts>;
  /// False if the BSDF doesn't use the random number that selects a lobe.
  static constexpr bool kHasLobes = !__is_same(Parts, bsdf::MatteParts<N>);

  [[nodiscard]] bsdf::Surface<N> load_surface() const {
    if constexpr (__is_same(FeaturesType, bsdf::PlainFeatures))
      return bsdf::Surface<N>::plain(lanes_.surface, i_);
    else
      return bsdf::Surface<N>::extended(lanes_.surface, i_, frame_);
  }

  void scatter(const ScatterSetup& setup, const bsdf::Surface<N>& surface,
               const bsdf::Coating<N>* coating) {
    V wo = frame_.to_local(-unit<N>(load3<N>(lanes_.d, i_)));
    wo.z = larger_of(wo.z, all<N>(bsdf::kGrazingCosine));
    const Bsdf bsdf(features_, surface, coating, wo);
    evaluate_light(setup, bsdf);
    sample_direction(setup, bsdf);
  }

  /// The lanes in which a direction is on the same side of the surface according to the geometric
  /// and the shading normal.
  [[nodiscard]] auto is_consistent(const V& wi, const F& local_z) const {
    const F cosine = dot(wi, outwards_);
    if (!features_.transmits)
      return (local_z > bsdf::least_reflected_cosine(features_)) & (cosine > 0);
    return ((local_z > 0) & (cosine > 0)) | ((local_z < 0) & (cosine < 0));
  }

  /// Computes the contribution of the light sample.
  void evaluate_light(const ScatterSetup& setup, const Bsdf& bsdf) {
    const V wi_world = load3<N>(lanes_.light_wi, i_), wi = frame_.to_local(wi_world);
    const F pdf = load<N>(lanes_.light_pdf + i_);
    bsdf::Evaluation<N> f = bsdf.evaluate(wi);
    if (setup.is_guided) {
      const F part = load<N>(lanes_.guide_part + i_);
      f.pdf = (1 - part) * f.pdf + part * load<N>(lanes_.light_guide_pdf + i_);
    }
    const F weight = pdf > 0 ? power_heuristic(pdf, f.pdf) : all<N>(1);
    V value = f.value;
    if (features_.transmits) {
      const V crossing = load3<N>(lanes_.through_weight, i_);
      value = select3(wi.z < 0, V(value * crossing), value);
    }
    const V color = (throughput_ * value * load3<N>(lanes_.light, i_)) * weight;
    store3<N>(lanes_.shadow, i_, select3(is_consistent(wi_world, wi.z), color, all3<N>(0)));
  }

  void sample_direction(const ScatterSetup& setup, const Bsdf& bsdf) {
    if (setup.is_guided) return sample_guided(bsdf);
    const auto sobol = load_sobol<N>(lanes_.key + i_, lanes_.index + i_);
    const bool plays_roulette = setup.most_survival < 1;
    Floats2<N> chances{};
    if (kHasLobes || plays_roulette) chances = sobol.pair(setup.lobe_pair);
    const auto u = sobol.pair(setup.direction_pair);
    const auto [local, e] = bsdf.sample(u, chances.x);
    const V wi = frame_.to_world(local);
    V next = throughput_ * (e.value / e.pdf);
    const auto is_below = local.z < 0;
    if (features_.transmits) {
      const V crossing = load3<N>(lanes_.through_weight, i_);
      next = select3(is_below, V(next * crossing), next);
      store<N>(lanes_.is_below + i_, is_below ? all<N>(1) : F{});
    }
    auto survives = (e.pdf > 0) & is_consistent(wi, local.z);
    if (plays_roulette) {
      const F survival = limited_survival<N>(survival_of<N>(next), next, setup.most_survival);
      survives = survives & (chances.y < survival);
      next = next / survival;  // not by its reciprocal, which may overflow
    }
    store3<N>(lanes_.wi, i_, wi);
    store3<N>(lanes_.next_throughput, i_, next);
    store<N>(lanes_.pdf + i_, survives ? e.pdf : F{});
  }

  /// Samples the BSDF, or takes the guide's sample.
  void sample_guided(const Bsdf& bsdf) {
    const F part = load<N>(lanes_.guide_part + i_), choice = load<N>(lanes_.chances[0] + i_);
    const Floats2<N> u{load<N>(lanes_.u[0] + i_), load<N>(lanes_.u[1] + i_)};
    const auto is_guided = choice < part;
    const F lobe = is_guided ? F{} : sampling::reused<N>(choice, part, 1 - part);
    const auto sample = bsdf.sample(u, lobe);
    const V guide_wi = load3<N>(lanes_.guide_wi, i_), guide_local = frame_.to_local(guide_wi);
    const bsdf::Evaluation<N> guided = bsdf.evaluate(guide_local);
    const V local = select3(is_guided, guide_local, sample.wi);
    const V wi = select3(is_guided, guide_wi, frame_.to_world(sample.wi));
    const F pdf = is_guided ? guided.pdf : sample.evaluation.pdf;
    V next = throughput_ * select3(is_guided, guided.value, sample.evaluation.value);
    if (features_.transmits) {
      const V crossing = load3<N>(lanes_.through_weight, i_);
      const auto is_below = local.z < 0;
      next = select3(is_below, V(next * crossing), next);
      store<N>(lanes_.is_below + i_, is_below ? all<N>(1) : F{});
    }
    store3<N>(lanes_.wi, i_, wi);
    store3<N>(lanes_.next_throughput, i_, next);
    store<N>(lanes_.pdf + i_, (pdf > 0) & is_consistent(wi, local.z) ? pdf : F{});
  }

  FeaturesType features_;
  ScatterLanes& lanes_;
  int i_;
  bsdf::Frame<N> frame_;
  V outwards_, throughput_;
};

template <int N, class Parts>
void scatter_all(const typename Parts::FeaturesType& features, const ScatterSetup& setup,
                 ScatterLanes& lanes) {
  for (int i = 0; i < kShadingLanes; i += N) Vertices<N, Parts>(features, lanes, i).scatter(setup);
}

template <int N>
void scatter_plain(const ScatterSetup& setup, ScatterLanes& lanes) {
  for (int i = 0; i < kShadingLanes; i += N) {
    if (bsdf::are_matte<N>(lanes.surface, i))
      Vertices<N, bsdf::MatteParts<N>>({}, lanes, i).scatter(setup);
    else
      Vertices<N, bsdf::PlainParts<N>>({}, lanes, i).scatter(setup);
  }
}

template <int N>
void scatter(const ScatterSetup& setup, ScatterLanes& lanes) {
  if (setup.features.index() == 0 && !setup.features.is_spec)
    scatter_plain<N>(setup, lanes);
  else if (setup.features.is_anisotropic)
    scatter_all<N, bsdf::AnisotropicParts<N>>(setup.features, setup, lanes);
  else
    scatter_all<N, bsdf::IsotropicParts<N>>(setup.features, setup, lanes);
}

}  // namespace microtrace
