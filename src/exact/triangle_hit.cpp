#include "exact/triangle_hit.hpp"

#include "exact/first_hit.hpp"
#include "exact/implicit.hpp"

namespace microtrace::exact {

const GridHit<3>& TriangleHit::wide() {
  if (!wide_) wide_.emplace(triangle_, *ray_);
  return *wide_;
}

const std::optional<Root>& TriangleHit::dyadic() {
  if (!dyadic_) dyadic_ = first_hit(triangle_, *ray_);
  return *dyadic_;
}

const Root& TriangleHit::root() {
  return *dyadic();
}

template <class Ask>
auto TriangleHit::on_grid(const Ask& ask) {
  if (narrow_.found() == Found::hit) {
    if (const auto answer = ask(narrow_)) return answer;
  }
  if (wide().found() == Found::hit) return ask(wide());
  return decltype(ask(narrow_))();
}

bool TriangleHit::exists() {
  if (narrow_.found() != Found::unknown) return narrow_.found() == Found::hit;
  if (wide().found() != Found::unknown) return wide().found() == Found::hit;
  return dyadic().has_value();
}

Enclosure TriangleHit::bounds() {
  const auto bounds = on_grid([](const auto& hit) { return std::optional(hit.bounds()); });
  return bounds ? *bounds : enclose(root());
}

float TriangleHit::t() {
  const auto t = on_grid([](const auto& hit) { return hit.t(); });
  return t ? *t : round_to_float(root());
}

Vec3 TriangleHit::point() {
  const auto p = on_grid([](const auto& hit) { return hit.point(); });
  return p ? *p : round_point(*ray_, root());
}

std::strong_ordering TriangleHit::order(const Triangle& other) {
  const auto order = on_grid([&](const auto& hit) { return hit.order(other); });
  return order ? *order : root() <=> *first_hit(other, *ray_);
}

int TriangleHit::side(const Triangle& other) {
  const auto side = on_grid([&](const auto& hit) { return hit.side(other); });
  return side ? *side : Implicit(other).sign_at(*ray_, root());
}

bool TriangleHit::meets_segment(const Triangle& other, const Vec3& q) {
  const auto meets = on_grid([&](const auto& hit) { return hit.meets_segment(other, q); });
  return meets ? *meets : exact::meets_segment(other, q, *ray_, root());
}

const GridPlane<3>& TrianglePlane::wide() {
  if (!wide_) wide_.emplace(triangle_);
  return *wide_;
}

template <class Ask>
auto TrianglePlane::on_grid(const Ask& ask) {
  const auto answer = ask(narrow_);
  return answer ? answer : ask(wide());
}

int TrianglePlane::side(const Vec3& q) {
  const auto side = on_grid([&](const auto& plane) { return plane.side(q); });
  return side ? *side : Implicit(triangle_).value(vector(q)).sign();
}

int TrianglePlane::slope(const Vec3& e) {
  const auto slope = on_grid([&](const auto& plane) { return plane.slope(e); });
  return slope ? *slope : dot(Implicit(triangle_).linear(), vector(e)).sign();
}

DVec3 TrianglePlane::normal() {
  const auto normal = on_grid([](const auto& plane) { return plane.normal(); });
  if (normal) return *normal;
  const Implicit f(triangle_);
  DVec3 n{0};
  for (int k = 0; k < 3; ++k) n[k] = to_double(f.linear()[k]);
  return n;
}

bool TrianglePlane::has_area() {
  const auto answer = on_grid([](const auto& plane) { return plane.has_area(); });
  return answer ? *answer : nonzero_component(Implicit(triangle_).linear()) >= 0;
}

}  // namespace microtrace::exact
