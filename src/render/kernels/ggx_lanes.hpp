#pragma once
/// bsdf::Ggx, bsdf::GgxAlbedo and the warps that they need, for N lanes. z is the normal.

#include "render/kernels/kernel.hpp"
#include "render/kernels/vector3.hpp"

namespace microtrace {
namespace {

constexpr float kInversePiLanes = 0.318309886183790671537767526745028724F;

/// table[index] for each lane.
template <int N>
inline Float<N> gathered(const float* table, const typename FloatVector<N>::bits_type& index) {
#if defined(__AVX512F__)
  if constexpr (N == 16)
    return _mm512_mask_i32gather_ps(_mm512_setzero_ps(), 0xffff, (__m512i)index, table, 4);
#endif
#if defined(__AVX2__)
  if constexpr (N == 8) return _mm256_i32gather_ps(table, (__m256i)index, 4);
#endif
  Float<N> result;
  for (int i = 0; i < N; ++i) result[i] = table[index[i]];
  return result;
}

template <int N>
struct PolarLanes {
  Float<N> cosine, sine;
};

/// sampling::unit_pair() for N lanes.
template <int N>
inline PolarLanes<N> unit_pair(const Float<N>& u) {
  using F = Float<N>;
  using Bits = typename FloatVector<N>::bits_type;
  const Bits quarter = __builtin_convertvector(4 * u + 0.5F, Bits);
  const F x = (u - __builtin_convertvector(quarter, F) * 0.25F) * 6.28318530717958648F;
  const F z = x * x;
  const F s = x + x * z * (-1 / 6.0F + z * (1 / 120.0F - z * (1 / 5040.0F)));
  const F c = 1 - z * (0.5F - z * (1 / 24.0F - z * (1 / 720.0F - z * (1 / 40320.0F))));
  const Bits swaps = (quarter & 1) != 0, second_half = (quarter & 2) != 0;
  const F cosine = swaps ? -s : c, sine = swaps ? c : s;
  return {second_half ? -cosine : cosine, second_half ? -sine : sine};
}

template <int N>
struct GgxLanes {
  using F = Float<N>;
  using V = Vector3<F>;

  F alpha, square;

  explicit GgxLanes(const F& roughness)
      : alpha(larger_of(roughness * roughness, all<N>(0.001F))), square(alpha * alpha) {}

  [[nodiscard]] F root(const F& z) const { return square_root<N>(square + (1 - square) * z * z); }
  [[nodiscard]] F distribution(const V& h) const {
    const F q = (h.x * h.x + h.y * h.y) / square + h.z * h.z;
    return kInversePiLanes / (square * q * q);
  }
  [[nodiscard]] F visibility(const F& z_o, const F& z_i) const {
    return 0.5F / (z_i * root(z_o) + z_o * root(z_i));
  }
  [[nodiscard]] F reflected_pdf(const F& z_o, const F& distribution) const {
    return distribution / (2 * (z_o + root(z_o)));
  }
  [[nodiscard]] V visible_normal(const V& wo, const F& ux, const F& uy) const {
    V v{alpha * wo.x, alpha * wo.y, wo.z};
    v = v / square_root<N>(dot(v, v));
    const auto [cosine, sine] = unit_pair<N>(ux);
    const F z = (1 - uy) * (1 + v.z) - v.z;
    const F r = square_root<N>(larger_of(1 - z * z, F{}));
    const V h{alpha * (r * cosine + v.x), alpha * (r * sine + v.y), z + v.z};
    return h / square_root<N>(dot(h, h));
  }
};

template <int N>
struct AlbedoLanes {
  Float<N> f1, schlick;
};

template <int N>
class GgxAlbedoLanes {
 public:
  using F = Float<N>;
  using Bits = typename FloatVector<N>::bits_type;

  GgxAlbedoLanes(const ScatterSetup& setup, const GgxLanes<N>& ggx)
      : setup_(setup), alpha_(ggx.alpha), row_(square_root<N>(alpha_), setup.albedo_steps) {}

  [[nodiscard]] AlbedoLanes<N> at(const F& z) const {
    const int steps = setup_.albedo_steps;
    return {mixed(setup_.albedo_f1, Cell(z * (1 + alpha_) / (z + alpha_), steps)),
            mixed(setup_.albedo_schlick, Cell(square_root<N>(z), steps))};
  }
  [[nodiscard]] AlbedoLanes<N> mean() const {
    return {row_.mixed(setup_.mean_albedo_f1, Bits{}),
            row_.mixed(setup_.mean_albedo_schlick, Bits{})};
  }

 private:
  struct Cell {
    Bits first;
    F share;

    Cell(const F& s, int steps) {
      const F step = s * static_cast<float>(steps - 1);
      const Bits whole = __builtin_convertvector(step, Bits), last = Bits{} + (steps - 2);
      const Bits within = last < whole ? last : whole;
      first = within < 0 ? Bits{} : within;  // directions below have no albedo
      share = step - __builtin_convertvector(first, F);
    }
    [[nodiscard]] F between(const F& a, const F& b) const { return a + share * (b - a); }
    [[nodiscard]] F mixed(const float* steps, const Bits& offset) const {
      return between(gathered<N>(steps, offset + first), gathered<N>(steps + 1, offset + first));
    }
  };
  [[nodiscard]] F mixed(const float* table, const Cell& column) const {
    const Bits row = row_.first * setup_.albedo_steps;
    return row_.between(column.mixed(table, row), column.mixed(table + setup_.albedo_steps, row));
  }

  const ScatterSetup& setup_;
  F alpha_;
  Cell row_;
};

}  // namespace
}  // namespace microtrace
