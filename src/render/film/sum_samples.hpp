#pragma once
/// Adds samples to the sums of pixels.

#include "render/lanes/film_lanes.hpp"
#include "render/lanes/shading_kernels.hpp"
#include "scene/math/luminance.hpp"
#include "simd/transpose.hpp"
#include "simd/vector3.hpp"

namespace microtrace {

/// What samples add to the sums of their pixels.
template <int N>
struct SampleTerms {
  Double<N> color[3], alpha;
  Double<N> square;  ///< of the displayed luminance
};

/// The terms of premultiplied colors over a background. Colors are clamped to `most`.
template <int N>
SampleTerms<N> sample_terms(const Double<N> (&color)[3], const Double<N>& alpha,
                            const double (&background)[3], double most) {
  using D = Double<N>;
  const D zero{}, one = zero + 1, limit = zero + most;
  SampleTerms<N> terms;
  terms.alpha = lesser<D>(one, greater<D>(zero, alpha));
  D shown[3];
  for (int c = 0; c < 3; ++c) {
    terms.color[c] = lesser<D>(limit, greater<D>(-limit, color[c]));
    shown[c] = lesser<D>(limit, terms.color[c] + (one - terms.alpha) * background[c]);
  }
  const D y = precise_luminance(Doubles3<N>{shown[0], shown[1], shown[2]});
  terms.square = y * y;
  return terms;
}

/// Loads N colors with alpha at a distance of `stride` samples, one component per vector.
template <int N>
void load_samples(const float* samples, std::size_t stride, Float<N> (&components)[4]) {
  std::uint32_t indices[N];
  for (int i = 0; i < N; ++i)
    indices[i] = static_cast<std::uint32_t>(stride) * static_cast<std::uint32_t>(i);
  load_rows<N>(samples, indices, components);
}

/// Adds a term to the sums of N pixels.
template <int N>
void add_term(const Double<N>& term, double part_scale, std::int64_t* whole, std::int64_t* part) {
  const Double<N> upper = term * 0x1p32;
  const Long<N> integer = truncated<N>(upper);
  const Double<N> rest = upper - to_double<N>(integer);
  Long<N> wholes, parts;
  __builtin_memcpy(&wholes, whole, sizeof wholes);
  __builtin_memcpy(&parts, part, sizeof parts);
  wholes += integer;
  parts += truncated<N>(rest * part_scale);
  __builtin_memcpy(whole, &wholes, sizeof wholes);
  __builtin_memcpy(part, &parts, sizeof parts);
}

/// Adds N samples, except those that are too large for TermSums or not numbers. Returns the latter.
template <int N>
Lanes sum_samples_of(const SumSetup& setup, const float* samples, std::size_t stride,
                     TermSums& sums, std::size_t pixel) {
  using D = Double<N>;
  Float<N> components[4];
  load_samples<N>(samples, stride, components);
  const D color[3] = {to_double<N>(components[0]), to_double<N>(components[1]),
                      to_double<N>(components[2])};
  SampleTerms<N> terms =
      sample_terms<N>(color, to_double<N>(components[3]), setup.background, setup.most);
  const D limit = D{} + TermSums::kLimit;
  // False for NaN. A color that is NaN makes the square NaN.
  const auto fits = (magnitude(terms.color[0]) < limit) & (magnitude(terms.color[1]) < limit) &
                    (magnitude(terms.color[2]) < limit) & (terms.square < limit) &
                    (terms.alpha == terms.alpha);
  const auto add = [&](TermSums::Term which, const D& term) {
    add_term<N>(fits ? term : D{}, setup.part_scale[which], sums.whole[which] + pixel,
                sums.part[which] + pixel);
  };
  for (int c = 0; c < 3; ++c) add(static_cast<TermSums::Term>(c), terms.color[c]);
  add(TermSums::alpha, terms.alpha);
  add(TermSums::square, terms.square);
  const Lanes added = less<N>(Float<N>{}, to_single<N>(fits ? D{} + 1 : D{}));
  for (int i = 0; i < N; ++i) sums.count[pixel + static_cast<std::size_t>(i)] += added >> i & 1U;
  return kAllLanes<N> & ~added;
}

template <int N>
Lanes sum_samples(const SumSetup& setup, const float* samples, std::size_t stride, TermSums& sums,
                  std::size_t pixel) {
  Lanes left = 0;
  for (std::size_t i = 0; i < kShadingLanes; i += N)
    left |= sum_samples_of<N>(setup, samples + 4 * stride * i, stride, sums, pixel + i) << i;
  return left;
}

}  // namespace microtrace
