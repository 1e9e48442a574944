#include "exact/intersect.hpp"
#include "exact/range.hpp"
#include "exact/vector.hpp"

namespace microtrace::exact {
namespace {

/// The interval of t for which t d lies in a set, built up from its parts.
class Span {
 public:
  void add(const Root& t) {
    if (empty_ || t < lo_) lo_ = t;
    if (empty_ || t > hi_) hi_ = t;
    empty_ = false;
  }

  [[nodiscard]] std::optional<Root> first(const Ray& ray) const {
    if (empty_) return std::nullopt;
    return first_in_range(lo_, hi_, ray);
  }

 private:
  bool empty_ = true;
  Root lo_, hi_;
};

/// Adds to span the t for which t d lies on the segment from p to q, given that det(d, p, q) = 0.
void add_segment(Span& span, const Vector& d, const Vector& p, const Vector& q) {
  // Offsets of p and q from the line, turned by 90 degrees: multiples of one vector, as d, p and q
  // lie in a plane.
  const Vector offset_p = cross(d, p);
  const Vector offset_q = cross(d, q);
  const Vector along = offset_q - offset_p;  // d x (q - p)
  const int k = nonzero_component(along);
  if (k < 0) {
    if (nonzero_component(offset_p) >= 0) return;  // parallel, beside the line
    const int i = nonzero_component(d);
    span.add(rational(p[i], d[i]));
    span.add(rational(q[i], d[i]));
    return;
  }
  if (offset_p[k].sign() * offset_q[k].sign() > 0) return;  // on the same side of the line
  // t d = p + s (q - p): taking the cross product with q - p leaves t d x (q - p) = p x q.
  span.add(rational(cross(p, q)[k], along[k]));
}

}  // namespace

std::optional<Root> first_hit(const Triangle& triangle, const Ray& ray) {
  if (!is_valid(ray) || !is_finite(triangle.a) || !is_finite(triangle.b) ||
      !is_finite(triangle.c)) {
    return std::nullopt;
  }
  const Vector o = vector(ray.o), d = vector(ray.d);
  const Vector a = vector(triangle.a) - o;
  const Vector b = vector(triangle.b) - o;
  const Vector c = vector(triangle.c) - o;

  // The line's signed volumes with the edges: its point in the plane has barycentric coordinates u
  // : v : w.
  const Vector b_cross_c = cross(b, c);
  const Dyadic u = dot(d, b_cross_c);
  const Dyadic v = dot(d, cross(c, a));
  if (u.sign() * v.sign() < 0) return std::nullopt;
  const Dyadic w = dot(d, cross(a, b));
  if (u.sign() * w.sign() < 0 || v.sign() * w.sign() < 0) return std::nullopt;

  if (u.sign() != 0 || v.sign() != 0 || w.sign() != 0) {
    return first_in_range(rational(dot(a, b_cross_c), u + v + w), ray);
  }
  // The ray lies in the triangle's plane, or the triangle is degenerate. The line then enters and
  // leaves the convex hull of the corners on its edges.
  Span span;
  add_segment(span, d, a, b);
  add_segment(span, d, b, c);
  add_segment(span, d, c, a);
  return span.first(ray);
}

}  // namespace microtrace::exact
