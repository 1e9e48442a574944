#include "oracle/cgal_intersections.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <type_traits>
#include <variant>

#include <CGAL/Mpzf.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/intersections.h>
#include <CGAL/version.h>

namespace microtrace::oracle {
namespace {

using Ring = CGAL::Simple_cartesian<CGAL::Mpzf>;
using Field = CGAL::Simple_cartesian<Rational>;

template <class Kernel>
using Corners = std::array<typename Kernel::Point_3, 3>;

template <class Kernel>
Corners<Kernel> corners(const Triangle& t) {
  return {point<Kernel>(t.a), point<Kernel>(t.b), point<Kernel>(t.c)};
}

/// Calls a visitor for what an intersection is. CGAL returns variants of Boost, from version 6 on
/// those of the standard library.
template <class Visitor, class Part>
auto visit_part(const Visitor& visitor, const Part& part) {
#if CGAL_VERSION_MAJOR >= 6
  return std::visit(visitor, part);
#else
  return boost::apply_visitor(visitor, part);
#endif
}

/// The convex hull of three vertices as a CGAL object of its dimension. A collinear Triangle_3
/// would violate CGAL's preconditions.
template <class Kernel>
using Hull =
    std::variant<typename Kernel::Triangle_3, typename Kernel::Segment_3, typename Kernel::Point_3>;

template <class Kernel>
Hull<Kernel> hull(const Corners<Kernel>& c) {
  if (!CGAL::collinear(c[0], c[1], c[2])) return typename Kernel::Triangle_3(c[0], c[1], c[2]);
  const auto [least, greatest] = std::minmax_element(c.begin(), c.end());  // lexicographic order
  if (*least == *greatest) return *least;
  return typename Kernel::Segment_3(*least, *greatest);
}

/// The part of the ray within its interval. The kernel's numbers are exact, so o + t d is not
/// rounded.
using Reach = std::variant<Ring::Ray_3, Ring::Segment_3, Ring::Point_3>;

bool is_zero(const Vec3& v) {
  return v.x == 0 && v.y == 0 && v.z == 0;
}

Reach reach(const Ray& ray) {
  const auto at = [&](float t) {
    return point<Ring>(ray.o) + CGAL::Mpzf(double{t}) * vector<Ring>(ray.d);
  };
  if (std::isinf(ray.t_max)) return Ring::Ray_3(at(ray.t_min), vector<Ring>(ray.d));
  if (ray.t_min == ray.t_max) return at(ray.t_min);
  return Ring::Segment_3(at(ray.t_min), at(ray.t_max));
}

struct Meet {
  template <class A, class B>
  bool operator()(const A& a, const B& b) const {
    return CGAL::do_intersect(a, b);
  }
  template <class A>
  bool operator()(const A& a, const Ring::Point_3& p) const {
    return a.has_on(p);
  }
  template <class B>
  bool operator()(const Ring::Point_3& p, const B& b) const {
    return b.has_on(p);
  }
  bool operator()(const Ring::Point_3& p, const Ring::Point_3& q) const { return p == q; }
};

/// Returns the least parameter of a point or segment that lies on the line o + t d.
class LeastParameter {
 public:
  explicit LeastParameter(const Ray& ray) : o_(point<Field>(ray.o)), d_(vector<Field>(ray.d)) {}

  Rational operator()(const Field::Point_3& p) const { return (p - o_) * d_ / (d_ * d_); }
  Rational operator()(const Field::Segment_3& s) const {
    return (std::min)((*this)(s.source()), (*this)(s.target()));
  }
  [[nodiscard]] Field::Line_3 line() const { return {o_, d_}; }

 private:
  Field::Point_3 o_;
  Field::Vector_3 d_;
};

}  // namespace

bool hits(const Triangle& triangle, const Ray& ray) {
  if (is_zero(ray.d)) return false;
  return std::visit(Meet{}, hull<Ring>(corners<Ring>(triangle)), reach(ray));
}

bool hits(const Plane& plane, const Ray& ray) {
  if (is_zero(ray.d) || is_zero(plane.normal)) return false;
  const auto n = vector<Ring>(plane.normal);
  const Ring::Plane_3 set(n.x(), n.y(), n.z(), -(n * (point<Ring>(plane.point) - CGAL::ORIGIN)));
  return std::visit([&](const auto& part) { return Meet{}(set, part); }, reach(ray));
}

bool meets_box(const Triangle& triangle, const Vec3& lo, const Vec3& hi) {
  const Field::Iso_cuboid_3 box(point<Field>(lo), point<Field>(hi));
  const auto meets = [&]<class Part>(const Part& part) {
    if constexpr (std::is_same_v<Part, Field::Point_3>)
      return !box.has_on_unbounded_side(part);
    else
      return CGAL::do_intersect(part, box);
  };
  return std::visit(meets, hull<Field>(corners<Field>(triangle)));
}

Rational first_parameter(const Triangle& triangle, const Ray& ray) {
  // Intersects with the line instead of the ray: CGAL 5.5 returns a wrong segment for a coplanar
  // ray that points away from the triangle.
  const LeastParameter least(ray);
  const auto of_set = [&](const auto& set) -> Rational {
    const auto common = CGAL::intersection(set, least.line());
    return visit_part([&](const auto& part) { return least(part); }, *common);
  };
  const auto shape = hull<Field>(corners<Field>(triangle));
  const Rational entry =
      std::holds_alternative<Field::Triangle_3>(shape)  ? of_set(std::get<Field::Triangle_3>(shape))
      : std::holds_alternative<Field::Segment_3>(shape) ? of_set(std::get<Field::Segment_3>(shape))
                                                        : least(std::get<Field::Point_3>(shape));
  return (std::max)(entry, Rational(double{ray.t_min}));
}

}  // namespace microtrace::oracle
