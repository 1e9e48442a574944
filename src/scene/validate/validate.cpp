#include "scene/validate/validate.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>

namespace microtrace {
namespace {

using Rule = std::optional<BrokenRule>;

template <typename Number>
std::string shortest(Number x) {
  std::array<char, 32> digits{};
  const auto result = std::to_chars(digits.data(), digits.data() + digits.size(), x);
  return {digits.data(), result.ptr};
}

/// Returns the first broken rule.
template <typename... Rules>
Rule first(Rules&&... rules) {
  Rule result;
  (void)((result = std::forward<Rules>(rules)).has_value() || ...);
  return result;
}

Rule broken(std::string field, std::string message) {
  return BrokenRule{.field = std::move(field), .message = std::move(message)};
}

bool fits_float32(float x) {
  return std::isfinite(x);
}
bool fits_float32(double x) {
  return std::abs(x) < kFloat32Bound;
}
template <glm::length_t n, typename Number>
bool fits_float32(const glm::vec<n, Number>& v) {
  for (glm::length_t i = 0; i < n; ++i)
    if (!fits_float32(v[i])) return false;
  return true;
}

template <typename T>
Rule finite(const char* field, const T& value) {
  if (fits_float32(value)) return {};
  return broken(field, "must be finite in float32; the largest number is about 3.4e38");
}

template <typename Number>
Rule positive(const char* field, Number x) {
  if (x > 0) return finite(field, x);
  return broken(field, std::string("must be positive, is ").append(decimal(x)));
}

template <typename Vector>
Rule not_zero(const char* field, const Vector& v) {
  if (Rule rule = finite(field, v)) return rule;
  if (Vec3(v) != Vec3(0)) return {};
  return broken(field, "must not be zero");
}

Rule check(const Sphere& s) {
  return first(finite("center", s.center), positive("radius", s.radius));
}

Rule check(const Plane& p) {
  return first(finite("point", p.point), not_zero("normal", p.normal));
}

Rule check(const Disc& d) {
  return first(finite("center", d.center), not_zero("normal", d.normal),
               positive("radius", d.radius));
}

Rule check(const Triangle& t) {
  return first(finite("a", t.a), finite("b", t.b), finite("c", t.c));
}

Rule check(const Quadric& q) {
  const bool all_finite = fits_float32(q.a) && fits_float32(q.b) && fits_float32(q.c) &&
                          fits_float32(q.d) && fits_float32(q.e) && fits_float32(q.f) &&
                          fits_float32(q.g) && fits_float32(q.h) && fits_float32(q.i) &&
                          fits_float32(q.j);
  if (!all_finite) return broken("coefficients", "must be finite in float32");
  const bool varies = q.a != 0 || q.b != 0 || q.c != 0 || q.d != 0 || q.e != 0 || q.f != 0 ||
                      q.g != 0 || q.h != 0 || q.i != 0;
  if (varies) return {};
  return broken("coefficients", "at least one of a to i must not be zero");
}

template <class T>
Rule all_finite(const char* field, const Array<T>& values) {
  for (const T& value : values) {
    if (Rule rule = finite(field, value)) return rule;
  }
  return {};
}

/// Checks vertex attributes other than positions.
Rule check_attributes(const Mesh& mesh) {
  const auto fits = [&](const auto& values) {
    return values.empty() || values.size() == mesh.positions.size();
  };
  const char* message = "must have as many elements as there are positions, or none";
  if (!fits(mesh.normals)) return broken("normals", message);
  if (!fits(mesh.tangents)) return broken("tangents", message);
  if (!fits(mesh.colors)) return broken("colors", message);
  for (const auto& set : mesh.uv_sets) {
    if (!fits(set)) return broken("uv_sets", message);
    if (Rule rule = all_finite("uv_sets", set)) return rule;
  }
  return first(all_finite("normals", mesh.normals), all_finite("tangents", mesh.tangents),
               all_finite("colors", mesh.colors));
}

template <typename Primitive>
Rule check_indices(const char* field, const Array<Primitive>& primitives, std::size_t positions) {
  for (const Primitive& primitive : primitives) {
    for (const std::uint32_t index : primitive) {
      if (index < positions) continue;
      std::string message = "index ";
      message.append(std::to_string(index)).append(" is not below the number of positions, ");
      return broken(field, message.append(std::to_string(positions)));
    }
  }
  return {};
}

Rule check_primitives(const Mesh& mesh) {
  if (Rule rule = check_indices("triangles", mesh.triangles, mesh.positions.size())) return rule;
  return check_indices("segments", mesh.segments, mesh.positions.size());
}

Rule check(const Mesh& mesh) {
  if (Rule rule = check_attributes(mesh)) return rule;
  if (Rule rule = all_finite("positions", mesh.positions)) return rule;
  return check_primitives(mesh);
}

Rule check(const Pose& pose) {
  Rule rule = first(finite("position", pose.position), not_zero("direction", pose.direction),
                    not_zero("up", pose.up));
  if (rule) return rule;
  // If the vectors were closer to parallel, rounding would rotate the picture about the viewing
  // direction.
  constexpr double kLeastSine = 1e-9;
  const double sine =
      glm::length(glm::cross(glm::normalize(pose.direction), glm::normalize(pose.up)));
  if (sine > kLeastSine) return {};
  const bool is_along_y = std::abs(pose.up.y) > std::abs(pose.up.z);
  return broken("up",
                std::string("must not be parallel to the viewing direction; use, for example, ")
                    .append(is_along_y ? "0,0,1" : "0,1,0"));
}

Rule check(const std::optional<double>& aspect_ratio) {
  return aspect_ratio ? positive("aspect_ratio", *aspect_ratio) : Rule{};
}

Rule not_negative(const char* field, double x) {
  if (x >= 0 && fits_float32(x)) return {};
  return broken(field, std::string("must be finite and not negative, is ").append(decimal(x)));
}

Rule check(const DepthRange& depth) {
  if (Rule rule = not_negative("near", depth.near)) return rule;
  if (depth.far > depth.near) return {};
  return broken("far", std::string("must be greater than near, is ").append(decimal(depth.far)));
}

/// Checks the lens. The directions of its rays must be finite.
Rule check_lens(const PerspectiveCamera& camera) {
  constexpr double kGreatestRatio = 1e60;
  if (Rule rule = not_negative("lens_radius", camera.lens_radius)) return rule;
  if (camera.lens_radius <= kGreatestRatio * camera.focus) return {};
  return broken(
      "lens_radius",
      std::string("must be at most 1e60 times focus, is ").append(decimal(camera.lens_radius)));
}

Rule check(const PerspectiveCamera& camera) {
  if (Rule rule = check(camera.pose)) return rule;
  if (!(camera.vertical_fov > 0 && camera.vertical_fov < std::numbers::pi)) {
    return broken("vertical_fov", std::string("must lie between 0 and pi, in radians, is ")
                                      .append(decimal(camera.vertical_fov)));
  }
  return first(positive("focus", camera.focus), check_lens(camera), check(camera.aspect_ratio),
               check(camera.depth));
}

Rule check(const OrthographicCamera& camera) {
  return first(check(camera.pose), positive("height", camera.height), check(camera.aspect_ratio),
               check(camera.depth));
}

Rule check(const EnvironmentCamera& camera) {
  return check(camera.pose);
}

Rule check(const RationalDistortion& d) {
  return first(finite("k1", d.k1), finite("k2", d.k2), finite("p1", d.p1), finite("p2", d.p2),
               finite("k3", d.k3), finite("k4", d.k4), finite("k5", d.k5), finite("k6", d.k6));
}

Rule check(const FisheyeDistortion& d) {
  return first(finite("k1", d.k1), finite("k2", d.k2), finite("k3", d.k3), finite("k4", d.k4));
}

Rule check_image(const CalibratedCamera& camera) {
  Rule rule = validate(camera.image);
  if (rule) rule->field.insert(0, rule->field.empty() ? "image" : "image/");
  return rule;
}

Rule check(const CalibratedCamera& camera) {
  return first(check(camera.pose), check_image(camera), positive("fx", camera.fx),
               positive("fy", camera.fy), finite("cx", camera.cx), finite("cy", camera.cy),
               std::visit([](const auto& d) { return check(d); }, camera.distortion),
               check(camera.depth));
}

Rule check_side(const char* field, std::uint32_t side) {
  if (side == 0) return broken(field, "must be at least 1 pixel, is 0");
  if (side <= kMaxImageSide) return {};
  std::string message = "must be at most ";
  message.append(std::to_string(kMaxImageSide)).append(" pixels, is ");
  return BrokenRule{field, message.append(std::to_string(side)), ErrorKind::limit};
}

}  // namespace

std::optional<BrokenRule> broken_index(const Mesh& mesh) {
  if (Rule rule = check_attributes(mesh)) return rule;
  return check_primitives(mesh);
}

std::optional<BrokenRule> broken_placement(const PlacedMesh& mesh) {
  if (!mesh.arrays->segments.empty())
    return BrokenRule{"segments", "must be empty if the mesh is placed"};
  for (int k = 0; k < 4; ++k) {
    if (Rule rule = finite("placement", mesh.placement->column(k))) return rule;
  }
  return std::nullopt;
}

std::optional<BrokenRule> validate(const Shape& shape) {
  return std::visit([](const auto& s) { return check(s); }, shape);
}

std::optional<BrokenRule> validate(const Camera& camera) {
  return std::visit([](const auto& c) { return check(c); }, camera);
}

std::optional<BrokenRule> validate(ImageSize size) {
  Rule rule = first(check_side("width", size.width), check_side("height", size.height));
  if (rule) return rule;
  const std::uint64_t pixels = std::uint64_t{size.width} * size.height;
  if (pixels <= kMaxImagePixels) return {};
  std::string message = "the picture must have at most ";
  message.append(std::to_string(kMaxImagePixels)).append(" pixels, has ");
  return BrokenRule{"", message.append(std::to_string(pixels)), ErrorKind::limit};
}

std::string decimal(double x) {
  return shortest(x);
}
std::string decimal(float x) {
  return shortest(x);
}

}  // namespace microtrace
