#pragma once
/// The importance of lights in light tree nodes, for N lanes.

#include "render/sampling/warps.hpp"
#include "simd/transpose.hpp"
#include "simd/vector3.hpp"
#include "simd/vectors.hpp"

#include <cstdint>

namespace microtrace {

/// A node of the light tree, in the tree's own units (LightTreeSpace). Nodes are plain data,
/// because the kernels of all instruction sets share them.
struct alignas(64) LightNode {
  float center[3];      ///< center of the bounding box
  float radius_square;  ///< squared radius of the box's bounding sphere
  float axis[3];        ///< axis of the cone of normals, of unit length
  float power;
  float cos_o, sin_o;  ///< cosine and sine of half the cone's opening angle
  float cos_e;         ///< cosine of the greatest angle to its normal at which a light emits
  float is_two_sided;  ///< 1 if the lights also emit around -axis
  std::uint32_t children = 0;  ///< index of the first of two adjacent children; 0 for leaves
  std::uint32_t light = 0;     ///< index of the light in a leaf
};

/// The units of a light tree. Lengths are multiples of its size and powers multiples of its total
/// power, so that float32 can represent squares of lengths. Points far away are moved closer, and
/// small numbers are replaced by kLeast.
struct LightTreeSpace {
  float origin[3] = {0, 0, 0};
  float scale = 1;  ///< a power of two
  double unit = 1;  ///< importance of 1 in world units: power / squared length

  static constexpr float kFarthest = 0x1p60F, kLeast = 0x1p-100F;

  template <int N>
  [[nodiscard]] Floats3<N> point(const Floats3<N>& p) const {
    // Half of the vector from the origin, because float32 may not represent the whole.
    const Floats3<N> half{0.5F * p.x - 0.5F * origin[0], 0.5F * p.y - 0.5F * origin[1],
                          0.5F * p.z - 0.5F * origin[2]};
    const Float<N> size =
        greatest_component(Floats3<N>{magnitude(half.x), magnitude(half.y), magnitude(half.z)});
    return half * smaller_of(Float<N>(kFarthest / size), all<N>(2 * scale));
  }
};

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
  using V = Floats3<N>;

  V center, axis;
  F radius_square, power, cos_o, sin_o, cos_e, is_two_sided;

  /// Puts the same node in all lanes.
  explicit LightNodes(const LightNode& node)
      : center{all<N>(node.center[0]), all<N>(node.center[1]), all<N>(node.center[2])},
        axis{all<N>(node.axis[0]), all<N>(node.axis[1]), all<N>(node.axis[2])},
        radius_square(all<N>(node.radius_square)),
        power(all<N>(node.power)),
        cos_o(all<N>(node.cos_o)),
        sin_o(all<N>(node.sin_o)),
        cos_e(all<N>(node.cos_e)),
        is_two_sided(all<N>(node.is_two_sided)) {}

  /// Loads the nodes with these indices.
  LightNodes(const LightNode* nodes, const std::uint32_t (&indices)[N]) {
    constexpr int kColumns = sizeof(LightNode) / sizeof(float);
    F columns[kColumns];
    load_rows<N>(nodes->center, indices, columns);
    center = {columns[0], columns[1], columns[2]};
    radius_square = columns[3];
    axis = {columns[4], columns[5], columns[6]};
    power = columns[7];
    cos_o = columns[8];
    sin_o = columns[9];
    cos_e = columns[10];
    is_two_sided = columns[11];
  }

  /// An upper bound of the light that arrives at p, except for the BSDF and a constant factor. `n`
  /// is the unit normal at p on either side. The result is positive unless no light arrives.
  [[nodiscard]] F importance(const V& p, const V& n) const {
    const F zero{}, one = all<N>(1), least_square = all<N>(LightTreeSpace::kLeast);
    const V to_light = p - center;
    const F square = dot(to_light, to_light);
    const V direction = to_light / square_root<N>(square);
    const F along = dot(axis, direction);
    const auto to_point =
        LightAngle<N>::of(smaller_of(is_two_sided != 0 ? magnitude(along) : along, one));
    // The angle subtended by the bounding sphere.
    const F sine_square = smaller_of(F(radius_square / square), one);
    const auto is_inside = square <= radius_square;
    const LightAngle<N> box{square_root<N>(1 - sine_square), square_root<N>(sine_square)};
    const LightAngle<N> off_cone = to_point - LightAngle<N>{cos_o, sin_o};
    const F least = is_inside ? one : (off_cone - box).cosine;
    const auto arriving = LightAngle<N>::of(smaller_of(magnitude(F(dot(direction, n))), one));
    const F least_arriving = is_inside ? one : (arriving - box).cosine;
    const F cosines = larger_of(least, zero) * larger_of(least_arriving, zero);
    const F outside =
        larger_of(F(power * cosines / larger_of(square, radius_square)), least_square);
    const auto is_reached = (cosines > 0) & (least >= cos_e);
    return square > least_square ? (is_reached ? outside : zero)
                                 : power / larger_of(radius_square, least_square);
  }
};

/// The minimum probability of a child that may contribute light, because the seemingly brighter
/// child may be occluded.
inline constexpr float kLeastProbability = 0x1p-12F;

/// The probability of selecting the first child of inner nodes, whose children start at these
/// indices; negative if neither child contributes.
template <int N>
Float<N> first_probability(const LightNode* nodes, const std::uint32_t (&children)[N],
                           const Floats3<N>& p, const Floats3<N>& n) {
  std::uint32_t differences = 0;
  for (int i = 1; i < N; ++i) differences |= children[i] ^ children[0];
  const LightNode* pairs = nodes + 1;
  const bool is_one = differences == 0;
  const auto first_nodes =
      is_one ? LightNodes<N>(nodes[children[0]]) : LightNodes<N>(nodes, children);
  const auto second_nodes =
      is_one ? LightNodes<N>(pairs[children[0]]) : LightNodes<N>(pairs, children);
  const Float<N> first = first_nodes.importance(p, n), second = second_nodes.importance(p, n);
  const Float<N> share = clamped(Float<N>(first / (first + second)), all<N>(kLeastProbability),
                                 all<N>(1 - kLeastProbability));
  const auto is_first = first > 0, is_second = second > 0;
  return is_first ? (is_second ? share : all<N>(1)) : (is_second ? Float<N>{} : all<N>(-1));
}

/// The probability of selecting a child with this conditional probability. It doesn't underflow.
template <int N>
Float<N> child_probability(const Float<N>& parent, const Float<N>& child) {
  return child > 0 ? larger_of(Float<N>(parent * child), all<N>(0x1p-126F)) : Float<N>{};
}

/// The light selected in each lane.
template <int N>
struct LightChoice {
  std::uint32_t light[N] = {};
  Float<N> probability{};  ///< selection probability at each point; 0 if no light reaches the point
};

/// Selects a light for each of the `wanted` lanes. p is in the units of the tree. u is in [0, 1).
template <int N>
LightChoice<N> choose_light(const LightNode* nodes, const Floats3<N>& p, const Floats3<N>& n,
                            Float<N> u, Lanes wanted) {
  using F = Float<N>;
  LightChoice<N> choice{.probability = all<N>(1)};
  std::uint32_t leaves[N] = {}, children[N];
  for (std::uint32_t& child : children) child = nodes[0].children;
  Lanes inner = nodes[0].children == 0 ? 0 : wanted;
  while (inner != 0) {
    const F first = first_probability<N>(nodes, children, p, n);
    const auto is_second = u >= first, is_inner = mask_of<N>(inner);
    const F share = is_second ? 1 - first : first;
    u = sampling::reused<N>(u, is_second ? first : F{}, share);
    const F selected = child_probability<N>(choice.probability, first < 0 ? F{} : share);
    choice.probability = is_inner ? selected : choice.probability;
    const Lanes seconds = less_equal<N>(all<N>(1), is_second ? all<N>(1) : F{});
    // Lanes without light need not descend further.
    Lanes rest = inner & less<N>(F{}, choice.probability);
    inner = 0;
    for (; rest != 0; rest &= rest - 1) {
      const int i = __builtin_ctz(rest);
      leaves[i] = children[i] + (seconds >> i & 1U);
      if (nodes[leaves[i]].children == 0) continue;
      children[i] = nodes[leaves[i]].children;
      inner |= Lanes{1} << i;
    }
    // Lanes that are done repeat the work of another lane, so that often all nodes are the same.
    if (inner == 0) break;
    const std::uint32_t some = children[__builtin_ctz(inner)];
    for (int i = 0; i < N; ++i) children[i] = (inner >> i & 1U) != 0 ? children[i] : some;
  }
  for (int i = 0; i < N; ++i) choice.light[i] = nodes[leaves[i]].light;
  return choice;
}

}  // namespace microtrace
