#include "support/cases/closed_bodies.hpp"

#include "exact/implicit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace microtrace::adversarial {
namespace {

using Corners = std::array<std::uint32_t, 3>;
using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// Three orthogonal directions, sometimes the coordinate axes.
std::array<DVec3, 3> random_frame(Random& random) {
  if (random.one_in(3)) return {DVec3(1, 0, 0), DVec3(0, 1, 0), DVec3(0, 0, 1)};
  const DVec3 z = glm::normalize(DVec3(random.in_cube(1)) + DVec3(1e-3, 0, 0));
  const DVec3 x = glm::normalize(glm::cross(z, DVec3(random.in_cube(1)) + DVec3(0, 0, 1e-3)));
  return {x, glm::cross(z, x), z};
}

/// `count` points around a circle, whose radii alternate between 1 and `inner`, and the circle's
/// axis.
std::vector<DVec3> rim(Random& random, int count, double inner) {
  const std::array<DVec3, 3> frame = random_frame(random);
  std::vector<DVec3> points;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * 3.14159265358979 * i / count, r = i % 2 == 0 ? 1 : inner;
    points.push_back(r * (std::cos(angle) * frame[0] + std::sin(angle) * frame[1]));
  }
  points.push_back(frame[2]);  // the last point is the axis
  return points;
}

struct Solid {
  std::vector<DVec3> positions;
  std::vector<Corners> triangles;
};

Solid prism(Random& random, int sides, const DVec3* offset = nullptr) {
  Solid solid{.positions = rim(random, sides, 1), .triangles = {}};
  const DVec3 along = offset != nullptr ? *offset : solid.positions.back();
  solid.positions.pop_back();
  const auto n = static_cast<std::uint32_t>(sides);
  for (std::uint32_t i = 0; i < n; ++i) solid.positions.push_back(solid.positions[i] + along);
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n;
    solid.triangles.push_back({i, j, n + i});
    solid.triangles.push_back({j, n + j, n + i});
    if (i < 2) continue;
    solid.triangles.push_back({0, i, i - 1});
    solid.triangles.push_back({n, n + i - 1, n + i});
  }
  return solid;
}

Solid double_cone(Random& random, int sides, double inner) {
  Solid solid{.positions = rim(random, sides, inner), .triangles = {}};
  const DVec3 axis = solid.positions.back() * double{random.power_of_two(-4, 2)};
  solid.positions.back() = axis;
  solid.positions.push_back(-axis);
  const auto n = static_cast<std::uint32_t>(sides);
  for (std::uint32_t i = 0; i < n; ++i) {
    solid.triangles.push_back({i, (i + 1) % n, n});
    solid.triangles.push_back({(i + 1) % n, i, n + 1});
  }
  return solid;
}

Solid box() {
  Solid solid;
  for (int i = 0; i < 8; ++i) solid.positions.emplace_back(i & 1, i >> 1 & 1, i >> 2 & 1);
  solid.triangles = {{0, 1, 2}, {1, 3, 2}, {4, 6, 5}, {5, 6, 7}, {0, 4, 1}, {1, 4, 5},
                     {2, 3, 6}, {3, 7, 6}, {0, 2, 4}, {2, 6, 4}, {1, 5, 3}, {3, 5, 7}};
  return solid;
}

Solid icosahedron(Random& random) {
  Solid solid;
  const std::array<DVec3, 3> frame = random_frame(random);
  const double golden = (1 + std::sqrt(5.0)) / 2;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const double s : {-1.0, 1.0}) {
      for (const double t : {-golden, golden})
        solid.positions.push_back((s * frame[(axis + 1) % 3] + t * frame[(axis + 2) % 3]) / golden);
    }
  }
  // Three vertices form a face if each two of them are as close as the ends of an edge.
  const auto is_edge = [&](std::uint32_t i, std::uint32_t j) {
    return glm::distance(solid.positions[i], solid.positions[j]) < 2.1 / golden;
  };
  for (std::uint32_t i = 0; i < 12; ++i) {
    for (std::uint32_t j = i + 1; j < 12; ++j) {
      for (std::uint32_t k = j + 1; k < 12; ++k) {
        if (is_edge(i, j) && is_edge(j, k) && is_edge(k, i)) solid.triangles.push_back({i, j, k});
      }
    }
  }
  return solid;
}

/// Returns the convex hull. Adds points one by one. Each new point replaces the faces that it sees,
/// and is joined to the edges around them.
Mesh hull(std::vector<Vec3> points) {
  Mesh mesh{.positions = std::move(points),
            .triangles = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}};
  const auto side = [&](const Corners& t, std::uint32_t i) {
    const Triangle triangle{mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]};
    return exact::Implicit(triangle).value(exact::vector(mesh.positions[i])).sign();
  };
  if (side(mesh.triangles[0], 3) > 0) {
    for (auto& t : mesh.triangles.edit()) std::swap(t[1], t[2]);
  }
  for (std::uint32_t i = 4; i < mesh.positions.size(); ++i) {
    // The edges of the faces that the point sees, with their directions in these faces. An edge
    // between two such faces cancels. If rounding makes faces overlap, more than two faces may
    // share an edge, and each pair of them cancels.
    std::map<Edge, Edge> edges;
    std::erase_if(mesh.triangles.edit(), [&](const auto& t) {
      if (side({t[0], t[1], t[2]}, i) <= 0) return false;
      for (std::size_t k = 0; k < 3; ++k) {
        const Edge edge{t[k], t[(k + 1) % 3]};
        const auto [place, is_new] = edges.try_emplace(std::minmax(edge.first, edge.second), edge);
        if (!is_new) edges.erase(place);
      }
      return true;
    });
    for (const auto& [corners, edge] : edges)
      mesh.triangles.push_back({edge.first, edge.second, i});
  }
  return mesh;
}

Mesh placed(const Solid& solid, const Vec3& center, float size) {
  Mesh mesh;
  for (const DVec3& p : solid.positions) mesh.positions.push_back(DVec3(center) + p * double{size});
  for (const Corners& t : solid.triangles) mesh.triangles.push_back({t[0], t[1], t[2]});
  return mesh;
}

float ulp(float x) {
  return std::nextafter(std::abs(x), std::numeric_limits<float>::infinity()) - std::abs(x);
}

/// Returns the largest spacing of float32 numbers at the body's position.
float greatest_ulp(const Vec3& center, float size) {
  return std::max({ulp(center.x), ulp(center.y), ulp(center.z), ulp(size)});
}

Mesh plate(Random& random, const Vec3& center, float size) {
  const double ulps = random.between(1, 4), unit = greatest_ulp(center, size) / double{size};
  DVec3 along = DVec3(random.on_grid(1)) * (ulps * unit);
  if (along == DVec3(0)) along.y = ulps * unit;
  return placed(prism(random, random.between(3, 15), &along), center, size);
}

Mesh shell(Random& random, const Vec3& center, float size) {
  const std::array inner_kinds = {BodyKind::hull, BodyKind::icosahedron, BodyKind::double_cone,
                                  BodyKind::box};
  const BodyKind kind = inner_kinds[random.bits() % inner_kinds.size()];
  Mesh mesh = closed_body(random, kind, center, size);
  const auto corners = static_cast<std::uint32_t>(mesh.positions.size());
  const std::size_t triangles = mesh.triangles.size();
  const double step = random.between(1, 4) * double{greatest_ulp(center, size)};
  DVec3 middle(0);
  for (const Vec3& p : mesh.positions) middle += DVec3(p) / double(corners);
  for (std::uint32_t i = 0; i < corners; ++i) {
    const DVec3 out = DVec3(mesh.positions[i]) - middle;
    const double length = std::max({std::abs(out.x), std::abs(out.y), std::abs(out.z)});
    const DVec3 inner = DVec3(mesh.positions[i]) - out * (length > 0 ? step / length : 0);
    mesh.positions.emplace_back(inner);
  }
  for (std::size_t i = 0; i < triangles; ++i) {
    const auto [a, b, c] = mesh.triangles[i];
    mesh.triangles.push_back({a + corners, b + corners, c + corners});
  }
  return mesh;
}

}  // namespace

const char* name(BodyKind kind) {
  switch (kind) {
    case BodyKind::hull:
      return "hull";
    case BodyKind::prism:
      return "prism";
    case BodyKind::icosahedron:
      return "icosahedron";
    case BodyKind::double_cone:
      return "double_cone";
    case BodyKind::star:
      return "star";
    case BodyKind::box:
      return "box";
    case BodyKind::plate:
      return "plate";
    case BodyKind::shell:
      return "shell";
  }
  return "";
}

Mesh closed_body(Random& random, BodyKind kind, const Vec3& center, float size) {
  switch (kind) {
    case BodyKind::hull: {
      std::vector<Vec3> points(static_cast<std::size_t>(random.between(4, 34)));
      for (Vec3& p : points) p = center + random.in_cube(size);
      return hull(std::move(points));
    }
    case BodyKind::prism:
      return placed(prism(random, random.between(3, 15)), center, size);
    case BodyKind::icosahedron:
      return placed(icosahedron(random), center, size);
    case BodyKind::double_cone:
      return placed(double_cone(random, random.between(3, 32), 1), center, size);
    case BodyKind::star:
      return placed(double_cone(random, 2 * random.between(2, 16), 0.3), center, size);
    case BodyKind::box:
      return placed(box(), center, size);
    case BodyKind::plate:
      return plate(random, center, size);
    case BodyKind::shell:
      return shell(random, center, size);
  }
  return {};
}

}  // namespace microtrace::adversarial
