#pragma once
/// The importance of lights in light tree nodes, for N lanes.

#include "render/lanes/light_node.hpp"
#include "render/sampling/warps.hpp"
#include "simd/lane_count.hpp"
#include "simd/transpose.hpp"
#include "simd/vector3.hpp"
#include "simd/vectors.hpp"

#include <cstddef>
#include <cstdint>

namespace microtrace {

inline namespace MICROTRACE_KERNELS {

/// Converts points from world units to those of the tree.
template <int N>
Floats3<N> in_tree_units(const LightTreeSpace& space, const Floats3<N>& p) {
  const float* const origin = space.origin;
  // Half of the vector from the origin, because float32 may not represent the whole.
  const Floats3<N> half{0.5F * p.x - 0.5F * origin[0], 0.5F * p.y - 0.5F * origin[1],
                        0.5F * p.z - 0.5F * origin[2]};
  const Float<N> size =
      greatest_component(Floats3<N>{magnitude(half.x), magnitude(half.y), magnitude(half.z)});
  return half * smaller_of(Float<N>(LightTreeSpace::kFarthest / size), all<N>(2 * space.scale));
}

/// An angle in [0, pi]: the cosine and sine times a common factor.
template <int N>
struct LightAngle {
  using F = Float<N>;

  F cosine, sine;

  /// `square` is the square of the factor.
  static LightAngle of(const F& cosine, const F& square) {
    return {cosine, square_root<N>(larger_of(F(square - cosine * cosine), F{}))};
  }
  /// The difference of two angles, which may be negative. Its factor is the product of both.
  friend LightAngle operator-(const LightAngle& a, const LightAngle& b) {
    return {a.cosine * b.cosine + a.sine * b.sine, a.sine * b.cosine - a.cosine * b.sine};
  }
};

/// N nodes, one in each lane.
template <int N>
struct LightNodes {
  using F = Float<N>;
  using V = Floats3<N>;

  V center;
  F radius, power, cos_o;
  Unsigned<N> children, light;
  // The members of the cones, unless is_everywhere().
  V axis{};
  F sin_o{}, cos_e{}, is_two_sided{};

  /// Puts the same node in all lanes.
  explicit LightNodes(const LightNode& node)
      : center{all<N>(node.center[0]), all<N>(node.center[1]), all<N>(node.center[2])},
        radius(all<N>(node.radius)),
        power(all<N>(node.power)),
        cos_o(all<N>(node.cos_o)),
        children(Unsigned<N>{} + node.children),
        light(Unsigned<N>{} + node.light) {
    if (is_everywhere()) return;
    const LightNode::Cone& cone = node.cone;
    axis = {all<N>(cone.axis[0]), all<N>(cone.axis[1]), all<N>(cone.axis[2])};
    sin_o = all<N>(cone.sin_o);
    cos_e = all<N>(cone.cos_e);
    is_two_sided = all<N>(cone.is_two_sided);
  }

  /// Loads the nodes with these indices.
  LightNodes(const LightNode* nodes, const std::uint32_t (&indices)[N]) {
    constexpr std::size_t kColumns = 8;  // the two halves of a node are rows
    static_assert(offsetof(LightNode, cone) == kColumns * sizeof(float) &&
                  sizeof(LightNode) == 2 * kColumns * sizeof(float));
    std::uint32_t rows[N];
    for (int i = 0; i < N; ++i) rows[i] = 2 * indices[i];
    F columns[kColumns];
    load_rows<N>(nodes->center, rows, columns);
    center = {columns[0], columns[1], columns[2]};
    radius = columns[3];
    power = columns[4];
    cos_o = columns[5];
    children = reinterpreted<Unsigned<N>>(columns[6]);
    light = reinterpreted<Unsigned<N>>(columns[7]);
    if (is_everywhere()) return;
    load_rows<N>(nodes->cone.axis, rows, columns);
    axis = {columns[0], columns[1], columns[2]};
    sin_o = columns[3];
    cos_e = columns[4];
    is_two_sided = columns[5];
  }

  /// True if all cones contain all directions, which is so for point lights.
  [[nodiscard]] bool is_everywhere() const { return less<N>(all<N>(-1), cos_o) == 0; }

  /// An upper bound of the light that arrives at p, except for the BSDF and a constant factor. `n`
  /// is the unit normal at p on either side. The result is positive unless no light arrives.
  [[nodiscard]] F importance(const V& p, const V& n) const {
    const F zero{}, one = all<N>(1), least = all<N>(LightTreeSpace::kLeast);
    const V from_light = p - center;
    const F square = dot(from_light, from_light), radius_square = radius * radius;
    const auto is_inside = square <= radius_square;
    const F inverse = 1 / larger_of(square, radius_square);
    // The angle subtended by the bounding sphere. The factor of this and the following angles is
    // the distance, which saves roots and divisions.
    const LightAngle<N> box{square_root<N>(larger_of(F(square - radius_square), zero)), radius};
    const auto least_cosine = [&](const LightAngle<N>& angle) {
      const LightAngle<N> rest = angle - box;
      // `rest` is more than -pi / 2, so its cosine tells 0 from pi, whose sine is 0 too.
      const auto is_within = (rest.sine <= 0) & (rest.cosine >= 0);
      return is_inside | is_within ? one : larger_of(F(rest.cosine * inverse), zero);
    };
    F cosines = least_cosine(LightAngle<N>::of(magnitude(F(dot(from_light, n))), square));
    auto is_reached = cosines > 0;
    if (!is_everywhere()) {
      const F along = dot(axis, from_light);
      const auto to_point = LightAngle<N>::of(is_two_sided != 0 ? magnitude(along) : along, square);
      const LightAngle<N> beyond = to_point - LightAngle<N>{cos_o, sin_o};
      const auto is_within = (beyond.sine <= 0) & ((beyond.cosine >= 0) | (cos_o < 0));
      const F emitted = is_within ? one : least_cosine(beyond);
      cosines = cosines * emitted;
      is_reached = (cosines > 0) & (emitted >= cos_e);
    }
    return is_reached ? larger_of(F(power * cosines * inverse), least) : zero;
  }
};

/// The minimum probability of a child that may contribute light, because the seemingly brighter
/// child may be occluded.
inline constexpr float kLeastProbability = 0x1p-12F;

/// The children of N inner nodes.
template <int N>
struct LightChildren {
  LightNodes<N> first, second;

  /// Loads the children, the first of which have these indices.
  LightChildren(const LightNode* nodes, const std::uint32_t (&indices)[N])
      : LightChildren(nodes, indices, are_same(indices)) {}

  /// The probability of selecting the first child; negative if neither child contributes.
  [[nodiscard]] Float<N> first_probability(const Floats3<N>& p, const Floats3<N>& n) const {
    const Float<N> of_first = first.importance(p, n), of_second = second.importance(p, n);
    const Float<N> share = clamped(Float<N>(of_first / (of_first + of_second)),
                                   all<N>(kLeastProbability), all<N>(1 - kLeastProbability));
    const auto is_first = of_first > 0, is_second = of_second > 0;
    return is_first ? (is_second ? share : all<N>(1)) : (is_second ? Float<N>{} : all<N>(-1));
  }

 private:
  LightChildren(const LightNode* nodes, const std::uint32_t (&indices)[N], bool are_same)
      : first(are_same ? LightNodes<N>(nodes[indices[0]]) : LightNodes<N>(nodes, indices)),
        second(are_same ? LightNodes<N>(nodes[indices[0] + 1])
                        : LightNodes<N>(nodes + 1, indices)) {}

  static bool are_same(const std::uint32_t (&indices)[N]) {
    std::uint32_t differences = 0;
    for (int i = 1; i < N; ++i) differences |= indices[i] ^ indices[0];
    return differences == 0;
  }
};

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

/// The state of a selection: the random numbers that are left, and the current children.
template <int N>
struct LightDescent {
  Floats3<N> p, n;  ///< p is in the units of the tree
  Float<N> u, probability;
  Unsigned<N> next, light;

  /// The same for fewer lanes, those with the numbers `from`.
  template <int M>
  [[nodiscard]] LightDescent<M> packed(const int (&from)[M]) const {
    LightDescent<M> few{};
    const auto pack = [&](const auto& all_lanes, auto& to) {
      for (int i = 0; i < M; ++i) to[i] = all_lanes[from[i]];
    };
    const auto pack3 = [&](const Floats3<N>& v, Floats3<M>& to) {
      pack(v.x, to.x);
      pack(v.y, to.y);
      pack(v.z, to.z);
    };
    pack3(p, few.p);
    pack3(n, few.n);
    pack(u, few.u);
    pack(probability, few.probability);
    pack(next, few.next);
    pack(light, few.light);
    return few;
  }
};

/// Descends from inner nodes to lights in the lanes `inner`. Continues in fewer lanes where few are
/// left: paths to lights differ in length, and often only some lanes need one of these lights.
template <int N>
void descend(const LightNode* nodes, LightDescent<N>& state, Lanes inner) {
  using F = Float<N>;
  while (inner != 0) {
    if constexpr (N > 4) {
      if (const int count = lane_count(inner); count <= N / 2) {
        int from[N / 2];
        Lanes rest = inner;
        for (int& one : from) {
          one = __builtin_ctz(rest);
          if ((rest & (rest - 1)) != 0) rest &= rest - 1;  // unused lanes repeat the last one
        }
        LightDescent<N / 2> few = state.packed(from);
        descend<N / 2>(nodes, few, (Lanes{1} << count) - 1);
        for (int i = 0; i < count; ++i) {
          state.light[from[i]] = few.light[i];
          state.probability[from[i]] = few.probability[i];
        }
        return;
      }
    }
    auto& [p, n, u, probability, next, light] = state;
    // Lanes that are done repeat the work of another lane, so that often all nodes are the same.
    next = mask_of<N>(inner) ? next : Unsigned<N>{} + lane(next, __builtin_ctz(inner));
    std::uint32_t indices[N];
    __builtin_memcpy(indices, &next, sizeof next);
    const LightChildren<N> children(nodes, indices);
    const F first = children.first_probability(p, n);
    const auto is_second = u >= first, is_inner = mask_of<N>(inner);
    const F share = is_second ? 1 - first : first;
    u = sampling::reused<N>(u, is_second ? first : F{}, share);
    const F selected = child_probability<N>(probability, first < 0 ? F{} : share);
    probability = is_inner ? selected : probability;
    // Lanes without light need not descend further.
    const Lanes lit = inner & less<N>(F{}, probability);
    next = is_second ? children.second.children : children.first.children;
    light = mask_of<N>(lit) ? (is_second ? children.second.light : children.first.light) : light;
    inner = lit & true_lanes<N>(next != 0);
  }
}

/// Selects a light for each of the `wanted` lanes. p is in the units of the tree. u is in [0, 1).
template <int N>
LightChoice<N> choose_light(const LightNode* nodes, const Floats3<N>& p, const Floats3<N>& n,
                            const Float<N>& u, Lanes wanted) {
  LightDescent<N> state{
      p, n, u, all<N>(1), Unsigned<N>{} + nodes[0].children, Unsigned<N>{} + nodes[0].light};
  descend<N>(nodes, state, nodes[0].children == 0 ? 0 : wanted);
  LightChoice<N> choice{.probability = state.probability};
  __builtin_memcpy(choice.light, &state.light, sizeof choice.light);
  return choice;
}

}  // namespace MICROTRACE_KERNELS
}  // namespace microtrace
