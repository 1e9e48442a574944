#include "explain/numbers.hpp"

#include "exact/first_hit.hpp"
#include "exact/flat.hpp"
#include "exact/implicit.hpp"
#include "exact/numbers/round_to_double.hpp"
#include "exact/planar.hpp"
#include "exact/range.hpp"

#include <array>
#include <cstddef>
#include <variant>

namespace microtrace {
namespace {

using exact::Dyadic;
using exact::round_to_double;
using exact::twice;
using exact::vector;

QuadraticNumbers quadratic(const Dyadic& a, const Dyadic& b, const Dyadic& c) {
  const Dyadic discriminant = square(b) - twice(twice(a * c));
  QuadraticNumbers result{.a = round_to_double(a),
                          .b = round_to_double(b),
                          .c = round_to_double(c),
                          .discriminant = round_to_double(discriminant),
                          .discriminant_sign = discriminant.sign(),
                          .a_sign = a.sign(),
                          .b_sign = b.sign(),
                          .c_sign = c.sign()};
  if (a.sign() != 0) {
    if (const auto roots = exact::quadratic_roots(twice(a), b, twice(c))) {
      result.roots.push_back(round_to_double(roots->lo));
      if (discriminant.sign() != 0) result.roots.push_back(round_to_double(roots->hi));
    }
  } else if (b.sign() != 0) {
    result.roots.push_back(round_to_double(exact::rational(-c, b)));
  }
  return result;
}

/// The numbers of F(o + t d) = 0, where F is quadratic.
QuadraticNumbers quadratic(const exact::Implicit& f, const Ray& ray) {
  const exact::Vector o = vector(ray.o), d = vector(ray.d);
  return quadratic(f.quadratic(d), f.slope(o, d), f.value(o));
}

/// The numbers of F(o + t d) = 0, where F is linear.
PlaneNumbers planar(const Dyadic& slope, const Dyadic& height) {
  PlaneNumbers result{.slope = round_to_double(slope),
                      .height = round_to_double(height),
                      .slope_sign = slope.sign(),
                      .height_sign = height.sign()};
  if (slope.sign() != 0) result.t = round_to_double(exact::rational(height, slope));
  return result;
}

PlaneNumbers planar(const exact::Implicit& f, const Ray& ray) {
  const exact::Vector o = vector(ray.o), d = vector(ray.d);
  return planar(f.slope(o, d), -f.value(o));
}

/// Computes the numbers of a ray and a shape that are valid.
class NumbersOf {
 public:
  explicit NumbersOf(const Ray& ray) : ray_(ray) {}

  IntersectionNumbers operator()(const Sphere& sphere) const {
    return quadratic(exact::Implicit(sphere), ray_);
  }
  IntersectionNumbers operator()(const Quadric& quadric) const {
    return quadratic(exact::Implicit(quadric), ray_);
  }
  IntersectionNumbers operator()(const Plane& plane) const {
    return planar(exact::Implicit(plane), ray_);
  }

  IntersectionNumbers operator()(const Disc& disc) const {
    const exact::Implicit f(disc);
    const exact::Vector o = vector(ray_.o), d = vector(ray_.d);
    const Dyadic slope = f.slope(o, d), height = -f.value(o),
                 r_squared = square(Dyadic(disc.radius));
    DiscNumbers result{.plane = planar(slope, height),
                       .squared_radius = round_to_double(r_squared)};
    if (slope.sign() != 0) {
      const Dyadic offset = exact::squared_offset(disc, ray_, height, slope);
      const Dyadic scale = square(slope);
      result.squared_distance = round_to_double(exact::rational(offset, scale));
      result.side = compare(offset, r_squared * scale);
    } else if (height.sign() == 0) {
      result.ball =
          quadratic(exact::Implicit(Sphere{.center = disc.center, .radius = disc.radius}), ray_);
    }
    return result;
  }

  IntersectionNumbers operator()(const Triangle& t) const {
    const exact::Vector o = vector(ray_.o), d = vector(ray_.d);
    const exact::CornersOf<Dyadic> corners{vector(t.a) - o, vector(t.b) - o, vector(t.c) - o};
    const auto& [a, b, c] = corners;
    const std::array volumes{exact::edge_volume(d, b, c), exact::edge_volume(d, c, a),
                             exact::edge_volume(d, a, b)};
    TriangleNumbers result{.plane = planar(exact::Implicit(t), ray_)};
    bool is_coplanar = true;
    for (std::size_t i = 0; i < 3; ++i) {
      result.volumes[i] = round_to_double(volumes[i]);
      result.signs[i] = volumes[i].sign();
      is_coplanar = is_coplanar && volumes[i].sign() == 0;
    }
    if (!is_coplanar) return result;
    if (const auto stretch = exact::meet(d, corners)) {
      result.stretch = {round_to_double(exact::rational(stretch->lo)),
                        round_to_double(exact::rational(stretch->hi))};
    }
    return result;
  }

 private:
  const Ray& ray_;
};

std::string_view derivation(const Sphere&) {
  return "docs/derivations.md#sphere";
}
std::string_view derivation(const Plane&) {
  return "docs/derivations.md#plane";
}
std::string_view derivation(const Disc&) {
  return "docs/derivations.md#disc";
}
std::string_view derivation(const Triangle&) {
  return "docs/derivations.md#triangle";
}
std::string_view derivation(const Quadric&) {
  return "docs/derivations.md#quadric";
}

// Each function returns why the line misses the shape; empty if the line meets it.
std::string reason(const std::monostate&) {
  return "the ray is invalid or the shape is empty";
}
std::string reason(const QuadraticNumbers& n) {
  if (n.a_sign != 0) return n.discriminant_sign < 0 ? "the discriminant is negative" : "";
  return n.b_sign == 0 && n.c_sign != 0 ? "a and b are 0, but c is not" : "";
}
std::string reason(const PlaneNumbers& n) {
  return n.slope_sign == 0 && n.height_sign != 0 ? "the ray is parallel to the plane" : "";
}
std::string reason(const DiscNumbers& n) {
  if (n.squared_distance)
    return n.side > 0 ? "the line crosses the plane outside of the radius" : "";
  if (n.ball)
    return n.ball->roots.empty() ? "the line lies in the plane outside of the radius" : "";
  return reason(n.plane);
}
std::string reason(const TriangleNumbers& n) {
  const std::string place = place_in_triangle(n);
  return place.starts_with("outside") ? "the line passes " + place : "";
}

}  // namespace

IntersectionNumbers intersection_numbers(const Primitives& primitives, const Ray& ray,
                                         PrimitiveId id) {
  if (!exact::is_valid(ray)) return {};
  return primitives.visit(id, [&](const auto& shape) {
    return exact::is_empty(shape) ? IntersectionNumbers() : NumbersOf(ray)(shape);
  });
}

std::string_view derivation_of(const Primitives& primitives, PrimitiveId id) {
  return primitives.visit(id, [](const auto& shape) { return derivation(shape); });
}

std::string miss_reason(const IntersectionNumbers& numbers) {
  const std::string text = std::visit([](const auto& n) { return reason(n); }, numbers);
  return text.empty() ? "the line meets the shape outside of the ray's interval" : text;
}

}  // namespace microtrace
