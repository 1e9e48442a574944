#pragma once
/// The importance of lights in light tree nodes, for N lanes.

#include "render/sampling/warps.hpp"
#include "simd/vector3.hpp"
#include "simd/vectors.hpp"

#include <cstdint>

namespace microtrace {

/// A node of the light tree. Derived values are float64, because squares and products of float32
/// numbers may exceed float32's range. Nodes are plain data, because the kernels of all instruction
/// sets share them.
struct LightNode {
  double center[3];      ///< center of the bounding box
  double radius_square;  ///< squared radius of the box's bounding sphere
  double power;
  float axis[3];       ///< axis of the cone of normals, of unit length
  float cos_o, sin_o;  ///< cosine and sine of half the cone's opening angle
  float cos_e;         ///< cosine of the greatest angle to its normal at which a light emits
  std::uint32_t is_two_sided;  ///< 1 if the lights also emit around -axis
  std::uint32_t is_leaf = 1;
  std::uint32_t second = 0;  ///< index of the second child; the first child follows its parent
  std::uint32_t light = 0;   ///< index of the light in a leaf
};

/// A number less than the square of any nonzero distance between float32 points.
inline constexpr double kLeastSquare = 0x1p-300;

/// An angle in [0, pi].
template <int N>
struct LightAngle {
  using F = Float<N>;

  F cosine, sine;

  static LightAngle of(const F& cosine) {
    return {cosine, square_root<N>(larger_of(F(1 - cosine * cosine), F{}))};
  }
  /// The difference of two angles, at least 0.
  friend LightAngle operator-(const LightAngle& a, const LightAngle& b) {
    const auto is_zero = a.cosine >= b.cosine;
    return {is_zero ? all<N>(1) : a.cosine * b.cosine + a.sine * b.sine,
            is_zero ? F{} : a.sine * b.cosine - a.cosine * b.sine};
  }
};

/// N nodes, one in each lane.
template <int N>
struct LightNodes {
  using F = Float<N>;
  using D = Double<N>;

  Doubles3<N> center;
  D radius_square, power;
  Floats3<N> axis;
  F cos_o, sin_o, cos_e, is_two_sided;

  /// Puts the same node in all lanes.
  explicit LightNodes(const LightNode& node)
      : center{D{} + node.center[0], D{} + node.center[1], D{} + node.center[2]},
        radius_square(D{} + node.radius_square),
        power(D{} + node.power),
        axis{all<N>(node.axis[0]), all<N>(node.axis[1]), all<N>(node.axis[2])},
        cos_o(all<N>(node.cos_o)),
        sin_o(all<N>(node.sin_o)),
        cos_e(all<N>(node.cos_e)),
        is_two_sided(all<N>(static_cast<float>(node.is_two_sided))) {}

  /// Loads the nodes with these indices.
  static LightNodes of(const LightNode* nodes, const std::uint32_t (&indices)[N]) {
    LightNodes result(nodes[indices[0]]);
    std::uint32_t differences = 0;
    for (int i = 1; i < N; ++i) differences |= indices[i] ^ indices[0];
    if (differences == 0) return result;
    double wide[5][N];
    float narrow[7][N];
    for (int i = 0; i < N; ++i) {
      const LightNode& node = nodes[indices[i]];
      for (int k = 0; k < 3; ++k) wide[k][i] = node.center[k];
      wide[3][i] = node.radius_square;
      wide[4][i] = node.power;
      for (int k = 0; k < 3; ++k) narrow[k][i] = node.axis[k];
      narrow[3][i] = node.cos_o;
      narrow[4][i] = node.sin_o;
      narrow[5][i] = node.cos_e;
      narrow[6][i] = static_cast<float>(node.is_two_sided);
    }
    result.center = {load_doubles<N>(wide[0]), load_doubles<N>(wide[1]), load_doubles<N>(wide[2])};
    result.radius_square = load_doubles<N>(wide[3]);
    result.power = load_doubles<N>(wide[4]);
    result.axis = {load<N>(narrow[0]), load<N>(narrow[1]), load<N>(narrow[2])};
    result.cos_o = load<N>(narrow[3]);
    result.sin_o = load<N>(narrow[4]);
    result.cos_e = load<N>(narrow[5]);
    result.is_two_sided = load<N>(narrow[6]);
    return result;
  }

  /// An upper bound of the light that arrives at p, except for the BSDF and a constant factor. `n`
  /// is the unit normal at p on either side.
  [[nodiscard]] D importance(const Doubles3<N>& p, const Floats3<N>& n) const {
    const F zero{}, one = all<N>(1);
    const D to_zero{};
    const Doubles3<N> to_light = p - center;
    const D square = dot(to_light, to_light);
    const Floats3<N> direction = to_single3<N>(to_light / square_root<N>(square));
    const F along = dot(axis, direction);
    const auto to_point =
        LightAngle<N>::of(smaller_of(is_two_sided != 0 ? magnitude(along) : along, one));
    // The angle subtended by the bounding sphere.
    const F sine_square = to_single<N>(smaller_of(D(radius_square / square), to_zero + 1));
    const auto is_inside = single_mask<N>(square <= radius_square);
    const LightAngle<N> box{square_root<N>(1 - sine_square), square_root<N>(sine_square)};
    const LightAngle<N> off_cone = to_point - LightAngle<N>{cos_o, sin_o};
    const F least = is_inside ? one : (off_cone - box).cosine;
    const auto arriving = LightAngle<N>::of(smaller_of(magnitude(F(dot(direction, n))), one));
    const F least_arriving = is_inside ? one : (arriving - box).cosine;
    const F cosines = larger_of(least, zero) * larger_of(least_arriving, zero);
    const D outside = power * to_double<N>(cosines) / larger_of(square, radius_square);
    const D reached = to_double<N>(least < cos_e ? zero : one) != 0 ? outside : to_zero;
    return square > 0 ? reached : power / larger_of(radius_square, to_zero + kLeastSquare);
  }
};

/// The minimum probability of a child that may contribute light, because the seemingly brighter
/// child may be occluded.
inline constexpr float kLeastProbability = 0x1p-12F;

/// The probability of selecting the first child of inner nodes; negative if neither child
/// contributes.
template <int N>
Float<N> first_probability(const LightNode* nodes, const std::uint32_t (&indices)[N],
                           const Doubles3<N>& p, const Floats3<N>& n) {
  std::uint32_t firsts[N], seconds[N];
  for (int i = 0; i < N; ++i) {
    firsts[i] = indices[i] + 1;
    seconds[i] = nodes[indices[i]].second;
  }
  const Double<N> first = LightNodes<N>::of(nodes, firsts).importance(p, n);
  const Double<N> second = LightNodes<N>::of(nodes, seconds).importance(p, n);
  const Float<N> share = clamped(to_single<N>(first / (first + second)), all<N>(kLeastProbability),
                                 all<N>(1 - kLeastProbability));
  const auto is_first = single_mask<N>(first > 0), is_second = single_mask<N>(second > 0);
  return is_first ? (is_second ? share : all<N>(1)) : (is_second ? Float<N>{} : all<N>(-1));
}

/// The light selected in each lane.
template <int N>
struct LightChoice {
  std::uint32_t light[N];
  Double<N> probability;  ///< selection probability at each point; 0 if no light reaches the point
};

/// Selects a light for each lane. u is in [0, 1).
template <int N>
LightChoice<N> choose_light(const LightNode* nodes, const Doubles3<N>& p, const Floats3<N>& n,
                            Float<N> u) {
  using F = Float<N>;
  LightChoice<N> choice{{}, Double<N>{} + 1};
  std::uint32_t indices[N] = {};
  for (;;) {
    float inner[N];
    bool is_done = true;
    for (int i = 0; i < N; ++i) {
      inner[i] = nodes[indices[i]].is_leaf != 0 ? 0.0F : 1.0F;
      is_done &= inner[i] == 0;
    }
    if (is_done) break;
    const auto is_inner = load<N>(inner) != 0;
    const F first = first_probability<N>(nodes, indices, p, n);
    const auto is_second = u >= first;
    const F share = is_second ? 1 - first : first;
    const F rest = sampling::reused<N>(u, is_second ? first : F{}, share);
    u = is_inner ? rest : u;
    const F part = is_inner ? (first < 0 ? F{} : share) : all<N>(1);
    choice.probability *= to_double<N>(part);
    const F step = is_second ? all<N>(1) : F{};
    for (int i = 0; i < N; ++i) {
      if (inner[i] == 0) continue;
      indices[i] = lane(step, i) != 0 ? nodes[indices[i]].second : indices[i] + 1;
    }
  }
  for (int i = 0; i < N; ++i) choice.light[i] = nodes[indices[i]].light;
  return choice;
}

}  // namespace microtrace
