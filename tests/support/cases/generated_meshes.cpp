#include "support/cases/generated_meshes.hpp"

#include "scene/math/trigonometry.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace microtrace::generated {
namespace {

std::uint32_t root(double x) {
  return static_cast<std::uint32_t>(std::max(1.0, std::floor(std::sqrt(x) + 0.5)));
}

/// Waves in several directions, with values of about -1 to 1.
double bumps(const DVec3& p) {
  double sum = 0, size = 0.5, frequency = 3;
  for (int octave = 0; octave < 5; ++octave) {
    sum += size * sin_radians(frequency * (p.x + 0.7 * p.y) + octave) *
           sin_radians(frequency * (p.y - 0.6 * p.z) + 2 * octave) *
           sin_radians(frequency * (p.z + 0.8 * p.x) + 3 * octave);
    size *= 0.55;
    frequency *= 2.1;
  }
  return sum;
}

/// Adds a surface of columns x rows cells with two triangles each. point(s, t) gives its points for
/// s and t in [0, 1].
template <class Point>
void add_grid(Mesh& mesh, std::uint32_t columns, std::uint32_t rows, Point point) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (std::uint32_t j = 0; j <= rows; ++j) {
    for (std::uint32_t i = 0; i <= columns; ++i)
      mesh.positions.emplace_back(point(double{1} * i / columns, double{1} * j / rows));
  }
  for (std::uint32_t j = 0; j < rows; ++j) {
    for (std::uint32_t i = 0; i < columns; ++i) {
      const std::uint32_t a = first + j * (columns + 1) + i, b = a + 1, c = a + columns + 1;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({b, c + 1, c});
    }
  }
}

/// Adds the parallelogram with this corner and the edges u and v.
void add_panel(Mesh& mesh, const DVec3& corner, const DVec3& u, const DVec3& v) {
  add_grid(mesh, 1, 1, [&](double s, double t) { return Vec3(corner + s * u + t * v); });
}

void add_box(Mesh& mesh, const DVec3& corner, const DVec3& u, const DVec3& v, const DVec3& w) {
  add_panel(mesh, corner, u, v);
  add_panel(mesh, corner, v, w);
  add_panel(mesh, corner, w, u);
  add_panel(mesh, corner + w, u, v);
  add_panel(mesh, corner + u, v, w);
  add_panel(mesh, corner + v, w, u);
}

/// Adds a surface of revolution around the vertical axis through `base`. profile(t) returns its
/// radius and height.
template <class Profile>
void add_lathe(Mesh& mesh, const DVec3& base, std::uint32_t around, std::uint32_t rows,
               Profile profile) {
  add_grid(mesh, around, rows, [&](double s, double t) {
    const double angle = 2 * std::numbers::pi * s;
    const auto [radius, height] = profile(t);
    return Vec3(base + DVec3(radius * cos_radians(angle), height, radius * sin_radians(angle)));
  });
}

void add_moved(Mesh& mesh, const Mesh& part, const DVec3& by, double scale) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (const Vec3& p : part.positions) mesh.positions.emplace_back(by + scale * DVec3(p));
  for (const auto& [a, b, c] : part.triangles)
    mesh.triangles.push_back({a + first, b + first, c + first});
}

struct RadiusHeight {
  double radius, height;
};

}  // namespace

// Returns an octahedron whose faces are divided into k x k triangles each, projected to a sphere
// and displaced.
Mesh displaced_sphere(std::size_t triangles) {
  const std::uint32_t k = root(static_cast<double>(triangles) / 8);
  Mesh mesh;
  // Projects the point of the octahedron |x| + |y| + |z| = k to the sphere and displaces it.
  const auto point = [&](std::int64_t x, std::int64_t y, std::int64_t z) {
    const DVec3 p = glm::normalize(DVec3(x, y, z));
    return Vec3(p * (1 + 0.15 * bumps(p)));
  };
  // Ring r has the points with z = k - r. If it is m rings from the nearer pole, it has 4 m points.
  // The poles are rings of one point.
  const auto ring_size = [&](std::uint32_t r) {
    const std::uint32_t m = r <= k ? r : 2 * k - r;
    return m == 0 ? 1U : 4 * m;
  };
  std::vector<std::uint32_t> first;
  for (std::uint32_t r = 0; r <= 2 * k; ++r) {
    first.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
    const std::int64_t m = r <= k ? r : 2 * k - r, z = std::int64_t{k} - r;
    for (std::uint32_t i = 0; i < ring_size(r); ++i) {
      const std::int64_t quarter = m == 0 ? 0 : i / m, step = m == 0 ? 0 : i % m;
      const std::array<std::array<std::int64_t, 2>, 4> xy{
          {{m - step, step}, {-step, m - step}, {step - m, -step}, {step, step - m}}};
      const auto [x, y] = xy[static_cast<std::size_t>(quarter)];
      mesh.positions.push_back(point(x, y, z));
    }
  }
  const auto at = [&](std::uint32_t r, std::uint32_t i) { return first[r] + i % ring_size(r); };
  for (std::uint32_t r = 0; r < 2 * k; ++r) {
    const bool widens = r < k;
    const std::uint32_t inner = widens ? r : r + 1, outer = widens ? r + 1 : r;
    const std::uint32_t m = ring_size(outer) / 4;  // points of a quarter of the longer ring
    for (std::uint32_t quarter = 0; quarter < 4; ++quarter) {
      for (std::uint32_t i = 0; i < m; ++i) {
        const std::uint32_t o = quarter * m + i, n = quarter * (m - 1) + i;
        mesh.triangles.push_back({at(outer, o), at(outer, o + 1), at(inner, n)});
        if (i + 1 < m) mesh.triangles.push_back({at(outer, o + 1), at(inner, n + 1), at(inner, n)});
      }
    }
  }
  return mesh;
}

Mesh terrain(std::size_t triangles) {
  const std::uint32_t n = root(static_cast<double>(triangles) / 2);
  Mesh mesh;
  add_grid(mesh, n, n, [](double s, double t) {
    const double x = 2 * s - 1, z = 2 * t - 1;
    return Vec3(x, 0.3 * bumps({x, 0.5, z}) + 0.1 * bumps({7 * z, 7 * x, 0.3}), z);
  });
  return mesh;
}

Mesh hall(std::size_t triangles) {
  Mesh mesh;
  add_box(mesh, {-20, 0, -10}, {40, 0, 0}, {0, 10, 0}, {0, 0, 20});
  constexpr int kColumns = 9;
  const double share = static_cast<double>(triangles) / (2 * kColumns);  // triangles per column
  const std::uint32_t around = std::clamp(root(share / 12), 6U, 96U);
  const std::uint32_t rows = std::max(1U, static_cast<std::uint32_t>(0.45 * share / (2 * around)));
  const Mesh bust = displaced_sphere(static_cast<std::size_t>(0.45 * share));
  for (int row = -1; row <= 1; row += 2) {
    for (int i = 0; i < kColumns; ++i) {
      const DVec3 base(-16 + 4 * i, 0, 5 * row);
      add_lathe(mesh, base, around, 1, [](double t) { return RadiusHeight{0.4, 7 * t}; });
      add_lathe(mesh, base + DVec3(0, 7, 0), around, rows, [](double t) {
        return RadiusHeight{0.4 + 0.3 * t + 0.03 * sin_radians(40 * t), 0.8 * t};
      });
      add_moved(mesh, bust, base + DVec3(2, 1.3, 0), 0.3);
      add_box(mesh, base + DVec3(1.7, 0, -0.3), {0.6, 0, 0}, {0, 1, 0}, {0, 0, 0.6});
      // A beam across the hall, and a slanted cloth.
      add_box(mesh, base + DVec3(0, 7.8, 0), {0.2, 0, 0.1}, {0, 0.3, 0.1}, {2, 1.9, -4.5 * row});
      add_panel(mesh, base + DVec3(0.5, 6.5, 0), {2.9, -1.5, 0.4}, {-0.8, -2.6, 0.5});
    }
  }
  return mesh;
}

DVec3 turned(const DVec3& p) {
  const double c1 = cos_degrees(25), s1 = sin_degrees(25), c2 = cos_degrees(15),
               s2 = sin_degrees(15);
  const double x = c1 * p.x + s1 * p.z, z = c1 * p.z - s1 * p.x;
  return {x, c2 * p.y + s2 * z, c2 * z - s2 * p.y};
}

Mesh turned(Mesh mesh) {
  for (Vec3& p : mesh.positions.edit()) p = Vec3(turned(DVec3(p)));
  return mesh;
}

}  // namespace microtrace::generated
