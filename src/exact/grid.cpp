#include "exact/grid.hpp"

#include "exact/first_hit.hpp"
#include "exact/queries.hpp"
#include "exact/range.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace microtrace::exact {
namespace {

constexpr int kMantissaBits = 24;

/// Coordinates are below 2^kCoordinateBits units, as Integer requires.
template <int Limbs>
constexpr int kCoordinateBits = 64 * Limbs - 8;

/// Number of spare high bits, which allow queries about other triangles with larger coordinates.
constexpr int kSpare = 16;

/// The number p / r 2^exponent.
template <int Limbs>
struct ScaledRatio {
  Ratio<Integer<Limbs>> value;
  int exponent;

  [[nodiscard]] Enclosure bounds() const {
    if (value.p.sign() == 0) return {0, 0};
    // Two truncations have an error of 2 u each, and the division adds one rounding.
    const Leading p = value.p.leading(), r = value.r.leading();
    return exact::bounds(value.p.sign(),
                         {p.mantissa / r.mantissa, p.exponent - r.exponent + exponent});
  }

  /// Compares this number with a nonzero x; nothing if their magnitudes differ too much.
  [[nodiscard]] std::optional<std::strong_ordering> compare(double x) const {
    int x_exponent = 0;
    const double mantissa = std::frexp(x, &x_exponent) * 0x1p53;  // an integer
    x_exponent -= 53;
    const auto m = Integer<2>::shifted(x < 0, static_cast<std::uint64_t>(std::abs(mantissa)), 0);
    // Compares p 2^shift with m r. Five more limbs hold the factors m < 2^53 and 2^255.
    const int shift = exponent - x_exponent;
    if (std::abs(shift) > 255) return std::nullopt;
    auto left = value.p.template widened<Limbs + 5>();
    auto right = (value.r * m).template widened<Limbs + 5>();
    shift >= 0 ? left = left << shift : right = right << -shift;
    return (left - right).sign() <=> 0;
  }

  [[nodiscard]] std::optional<float> rounded() const {
    std::optional<std::strong_ordering> order = std::strong_ordering::equal;
    const float result = round_to_float(bounds(), [&](double middle) {
      order = compare(middle);
      return order.value_or(std::strong_ordering::equal);
    });
    return order ? std::optional(result) : std::nullopt;
  }
};

/// Returns true if t is within the ray's interval, or nothing if the bounds of t can't decide.
std::optional<bool> is_in_range(const Enclosure& t, const Ray& ray) {
  if (t.hi < ray.t_min || t.lo > ray.t_max) return false;
  if (t.lo >= ray.t_min && t.hi <= ray.t_max) return true;
  return std::nullopt;
}

}  // namespace

template <int Limbs>
Grid<Limbs>::Grid(std::initializer_list<Vec3> vectors, int spare) {
  float largest = 0;
  for (const Vec3& v : vectors) {
    for (int k = 0; k < 3; ++k) largest = std::max(largest, std::abs(v[k]));
  }
  exponent_ = decode(largest).exponent + kMantissaBits + spare - kCoordinateBits<Limbs>;
}

template <int Limbs>
auto Grid<Limbs>::operator()(const Vec3& v) const -> std::optional<GridVector> {
  std::array<Integer<Limbs>, 3> result;
  if (!is_finite(v)) return std::nullopt;
  for (int k = 0; k < 3; ++k) {
    auto [negative, mantissa, exponent] = decode(v[k]);
    if (mantissa == 0) continue;
    int shift = exponent - exponent_;
    if (shift < 0) {
      // Trailing zero bits of the mantissa may be below the unit.
      if (std::countr_zero(mantissa) < -shift) return std::nullopt;
      mantissa >>= static_cast<unsigned>(-shift);
      shift = 0;
    }
    if (shift > kCoordinateBits<Limbs> - kMantissaBits) return std::nullopt;
    result[static_cast<std::size_t>(k)] = Integer<Limbs>::shifted(negative, mantissa, shift);
  }
  return GridVector{result[0], result[1], result[2]};
}

template <int Limbs>
auto Grid<Limbs>::operator()(const Triangle& t, const GridVector& from) const
    -> std::optional<GridCorners> {
  const auto a = (*this)(t.a), b = (*this)(t.b), c = (*this)(t.c);
  if (!a || !b || !c) return std::nullopt;
  return GridCorners{*a - from, *b - from, *c - from};
}

template <int Limbs>
GridPlane<Limbs>::GridPlane(const Triangle& triangle)
    : grid_({triangle.a, triangle.b, triangle.c}, kSpare) {
  ++queries.grid;
  const auto corners = grid_(triangle, {});
  if (!corners) return;
  a_ = corners->a;
  normal_ = normal_of(*corners);
}

template <int Limbs>
std::optional<int> GridPlane<Limbs>::side(const Vec3& q) const {
  const auto on_grid = grid_(q);
  if (!normal_ || !on_grid) return std::nullopt;
  return dot(*on_grid - a_, *normal_).sign();
}

template <int Limbs>
std::optional<int> GridPlane<Limbs>::slope(const Vec3& e) const {
  const auto on_grid = Grid<Limbs>({e}, 0)(e);
  if (!normal_ || !on_grid) return std::nullopt;
  return dot(*on_grid, *normal_).sign();
}

template <int Limbs>
std::optional<DVec3> GridPlane<Limbs>::normal() const {
  if (!normal_) return std::nullopt;
  DVec3 n{0};
  for (int k = 0; k < 3; ++k) {
    if ((*normal_)[k].sign() == 0) continue;
    Leading size = (*normal_)[k].leading();
    size.exponent += 2 * grid_.exponent();
    n[k] = middle((*normal_)[k].sign(), size);
  }
  return n;
}

template <int Limbs>
std::optional<bool> GridPlane<Limbs>::has_area() const {
  if (!normal_) return std::nullopt;
  return nonzero_component(*normal_) >= 0;
}

template <int Limbs>
GridHit<Limbs>::GridHit(const Triangle& triangle, const Ray& ray)
    : points_({ray.o, triangle.a, triangle.b, triangle.c}, kSpare), directions_({ray.d}, 0) {
  find(triangle, ray);
}

template <int Limbs>
void GridHit<Limbs>::find(const Triangle& triangle, const Ray& ray) {
  ++queries.grid;
  const auto o = points_(ray.o), d = directions_(ray.d);
  if (!o || !d || !is_valid(ray)) return;
  o_ = *o;
  d_ = *d;
  const auto corners = points_(triangle, o_);
  if (!corners) return;
  const auto stretch = meet(d_, *corners);
  found_ = Found::miss;
  if (!stretch) return;
  const int exponent = points_.exponent() - directions_.exponent();
  t_ = stretch->lo;
  bounds_ = ScaledRatio<3 * Limbs>{t_, exponent}.bounds();
  const std::optional<bool> is_hit = is_in_range(bounds_, ray);
  if (is_hit.value_or(false))
    found_ = Found::hit;
  else if (!is_hit || !stretch->is_point)
    found_ = Found::unknown;  // the stretch may begin before the ray's interval and reach into it
}

template <int Limbs>
std::optional<float> GridHit<Limbs>::t() const {
  return ScaledRatio<3 * Limbs>{t_, points_.exponent() - directions_.exponent()}.rounded();
}

template <int Limbs>
std::optional<Vec3> GridHit<Limbs>::point() const {
  Vec3 p{0};
  for (int k = 0; k < 3; ++k) {
    const std::optional<float> x =
        ScaledRatio<4 * Limbs>{{o_[k] * t_.r + d_[k] * t_.p, t_.r.template widened<4 * Limbs>()},
                               points_.exponent()}
            .rounded();
    if (!x) return std::nullopt;
    p[k] = *x;
  }
  return p;
}

template <int Limbs>
std::optional<std::strong_ordering> GridHit<Limbs>::order(const Triangle& other) const {
  const auto corners = points_(other, o_);
  if (!corners) return std::nullopt;
  const auto stretch = meet(d_, *corners);
  // If the stretch is not a point, the hit may be at the start of the ray's interval instead of
  // stretch->lo.
  if (!stretch || !stretch->is_point) return std::nullopt;
  return compare(t_, stretch->lo);
}

template <int Limbs>
std::optional<int> GridHit<Limbs>::side(const Triangle& other) const {
  const auto corners = points_(other, o_);
  if (!corners) return std::nullopt;
  const auto normal = normal_of(*corners);
  return sign_of_sum(-dot(corners->a, normal), t_, dot(d_, normal));
}

template <int Limbs>
std::optional<bool> GridHit<Limbs>::meets_segment(const Triangle& other, const Vec3& q) const {
  const auto from = points_(q);
  if (!from) return std::nullopt;
  const auto corners = points_(other, *from);
  if (!corners) return std::nullopt;
  return meets_segment_to(*corners, o_ - *from, d_,
                          [&](const auto& x, const auto& y) { return sign_of_sum(x, t_, y); });
}

template class Grid<2>;
template class Grid<3>;
template class GridPlane<2>;
template class GridPlane<3>;
template class GridHit<2>;
template class GridHit<3>;

}  // namespace microtrace::exact
