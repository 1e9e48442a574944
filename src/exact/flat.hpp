#pragma once
/// Formulas for triangles and their planes, generic over the exact number type.

#include "exact/numbers/dyadic.hpp"
#include "exact/numbers/integer.hpp"
#include "exact/numbers/ratio.hpp"
#include "exact/numbers/vector.hpp"

#include <optional>

namespace microtrace::exact {

template <class Number>
struct CornersOf {
  VectorOf<Number> a, b, c;
};

/// The type of polynomials of degree three in numbers of this type.
template <class Number>
using Volume = decltype(Number() * Number() * Number());

/// Returns d . (p x q), six times the signed volume spanned by a line's direction d and a segment.
/// Its sign tells on which side the line through (0, 0, 0) passes the segment.
template <class Number>
[[nodiscard]] Volume<Number> edge_volume(const VectorOf<Number>& d, const VectorOf<Number>& p,
                                         const VectorOf<Number>& q) {
  return dot(d, cross(p, q));
}

/// The interval [lo, hi] of t for which the point o + t d of a line is in a triangle.
template <class Number>
struct StretchOf {
  Ratio<Volume<Number>> lo, hi;
  bool is_point;  ///< true if lo = hi

  /// Extends the interval to contain t.
  void add(const Ratio<Volume<Number>>& t) {
    if (compare(t, lo) < 0) lo = t;
    if (compare(t, hi) > 0) hi = t;
    is_point = compare(lo, hi) == 0;
  }
};

/// Returns x widened to the width of the first argument.
[[nodiscard]] inline const Dyadic& as_wide_as(const Dyadic&, const Dyadic& x) {
  return x;
}
template <int More, int Limbs>
[[nodiscard]] Integer<More> as_wide_as(const Integer<More>&, const Integer<Limbs>& x) {
  return x.template widened<More>();
}

/// Calls add(numerator, denominator) for each t that bounds the part of the line t d on the segment
/// from p to q, given det(d, p, q) = 0. There is one t for a crossing, two if the segment lies on
/// the line, and none for a miss.
template <class Number, class Add>
void for_each_end(const VectorOf<Number>& d, const VectorOf<Number>& p, const VectorOf<Number>& q,
                  const Add& add) {
  // Offsets of p and q from the line times |d|, rotated by 90 degrees. They are parallel because d,
  // p and q are coplanar.
  const auto offset_p = cross(d, p);
  const auto offset_q = cross(d, q);
  const auto along = offset_q - offset_p;  // d x (q - p)
  const int k = nonzero_component(along);
  if (k < 0) {
    if (nonzero_component(offset_p) >= 0) return;  // parallel to the line, but not on it
    const int i = nonzero_component(d);
    add(p[i], d[i]);
    add(q[i], d[i]);
    return;
  }
  if (offset_p[k].sign() * offset_q[k].sign() > 0) return;  // both ends are on the same side
  // t d = p + s (q - p): taking the cross product with q - p leaves t d x (q - p) = p x q.
  add(cross(p, q)[k], along[k]);
}

/// Returns the interval of t in which the line t d meets a triangle, or nothing if it misses. The
/// vertices are relative to the line's origin.
template <class Number>
[[nodiscard]] std::optional<StretchOf<Number>> meet(const VectorOf<Number>& d,
                                                    const CornersOf<Number>& corners) {
  using Form = Volume<Number>;
  const auto& [a, b, c] = corners;
  // u, v and w are the signed volumes spanned by the line and the edges. The intersection with the
  // plane has the barycentric coordinates u : v : w.
  const auto b_cross_c = cross(b, c);
  const Form u = dot(d, b_cross_c);
  const Form v = edge_volume(d, c, a);
  if (u.sign() * v.sign() < 0) return std::nullopt;
  const Form w = edge_volume(d, a, b);
  if (u.sign() * w.sign() < 0 || v.sign() * w.sign() < 0) return std::nullopt;

  if (u.sign() != 0 || v.sign() != 0 || w.sign() != 0) {
    const auto t = ratio<Form>(dot(a, b_cross_c), u + v + w);
    return StretchOf<Number>{.lo = t, .hi = t, .is_point = true};
  }
  // The line lies in the triangle's plane, or the triangle is degenerate. In both cases the line
  // enters and leaves the triangle at points of its edges.
  std::optional<StretchOf<Number>> stretch;
  const auto add = [&](const auto& p, const auto& r) {
    const auto t = ratio<Form>(as_wide_as(u, p), as_wide_as(u, r));
    if (!stretch)
      stretch = {.lo = t, .hi = t, .is_point = true};
    else
      stretch->add(t);
  };
  for_each_end(d, a, b, add);
  for_each_end(d, b, c, add);
  for_each_end(d, c, a, add);
  return stretch;
}

/// Returns a triangle's normal (b - a) x (c - a).
template <class Number>
[[nodiscard]] auto normal_of(const CornersOf<Number>& t) {
  return cross(t.b - t.a, t.c - t.a);
}

/// Returns the sign of x + t y.
template <class Number>
[[nodiscard]] int sign_of_sum(const Number& x, const Ratio<Number>& t, const Number& y) {
  return (x * t.r + y * t.p).sign();
}

/// Returns true if a triangle of nonzero area has a common point with the segment from (0, 0, 0) to
/// o + t d, which lies in the triangle's plane. If they have none, the line of an edge or of the
/// segment separates them strictly. side_at(x, y) must return the sign of x + t y.
template <class Number>
[[nodiscard]] bool meets_segment_of_plane(const CornersOf<Number>& triangle,
                                          const VectorOf<Number>& o, const VectorOf<Number>& d,
                                          const auto& side_at) {
  const int k = nonzero_component(normal_of(triangle));
  const auto area = [&](const VectorOf<Number>& x, const VectorOf<Number>& y) {
    return as_wide_as(Volume<Number>(), cross(x, y)[k]);
  };
  const auto is_apart_by = [&](const auto& a, const auto& b, const auto& c) {
    const VectorOf<Number> edge = b - a;
    const int within = area(edge, c - a).sign();
    return area(a, edge).sign() == -within && side_at(area(edge, o - a), area(edge, d)) == -within;
  };
  const auto& [a, b, c] = triangle;
  if (is_apart_by(a, b, c) || is_apart_by(b, c, a) || is_apart_by(c, a, b)) return false;
  const auto side = [&](const VectorOf<Number>& p) { return side_at(area(o, p), area(d, p)); };
  const int first = side(a);
  return first == 0 || side(b) != first || side(c) != first;
}

/// Returns true if a triangle of nonzero area has a common point with the segment from (0, 0, 0) to
/// o + t d. The ends of the segment must not both be strictly on the same side of the triangle's
/// plane. The result follows from the sides on which the segment's line passes the edges.
/// side_at(x, y) must return the sign of x + t y.
template <class Number>
[[nodiscard]] bool meets_segment_to(const CornersOf<Number>& triangle, const VectorOf<Number>& o,
                                    const VectorOf<Number>& d, const auto& side_at) {
  const auto& [a, b, c] = triangle;
  const auto side = [&](const VectorOf<Number>& p, const VectorOf<Number>& r) {
    const auto normal = cross(p, r);
    return side_at(dot(o, normal), dot(d, normal));
  };
  const int u = side(b, c), v = side(c, a), w = side(a, b);
  if (u == 0 && v == 0 && w == 0) return meets_segment_of_plane(triangle, o, d, side_at);
  return u * v >= 0 && v * w >= 0 && w * u >= 0;
}

}  // namespace microtrace::exact
