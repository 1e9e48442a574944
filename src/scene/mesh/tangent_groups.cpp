#include "scene/mesh/tangent_groups.hpp"

#include "scene/math/trigonometry.hpp"
#include "scene/mesh/edge_neighbors.hpp"
#include "scene/mesh/weld.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

// Follows chapter 2 of Mikkelsen's thesis (see tangents.hpp) and the rules of its implementation,
// mikktspace.c. Vertices with equal attributes are merged. Triangles around a vertex share its
// tangent if they are connected by edges and have the same winding in texture space. Each triangle
// is weighted by its angle at the vertex. Triangles with no area in texture space join any group
// and add nothing to its tangent.

namespace microtrace {
namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};

/// Larger groups are not searched for opposite directions, because the search takes quadratic time.
constexpr std::size_t kMostCompared = 256;

bool is_zero(float x) {
  return !(std::abs(x) > std::numeric_limits<float>::min());
}

bool is_zero(const Vec3& v) {
  return is_zero(v.x) && is_zero(v.y) && is_zero(v.z);
}

Vec3 unit_or_zero(const Vec3& v) {
  return is_zero(v) ? v : v / std::sqrt(glm::dot(v, v));
}

/// Projects v onto the plane perpendicular to the unit normal n, and normalizes the result.
Vec3 across(const Vec3& v, const Vec3& n) {
  return unit_or_zero(v - n * glm::dot(n, v));
}

/// Normalized derivatives of a triangle's position with respect to its texture coordinates.
struct Frame {
  Vec3 s{0}, t{0};
  bool preserves = false;  ///< true if the triangle has the same winding in texture space
  bool joins_any = true;   ///< true if the triangle has no tangent of its own and joins any group
};

class Grouping {
 public:
  explicit Grouping(const TangentSource& mesh)
      : mesh_(mesh), vertex_of_(welded(mesh.positions, mesh.normals, mesh.uv)) {
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
      std::array<std::uint32_t, 3> corners{};
      std::ranges::transform(mesh.triangles[i], corners.begin(),
                             [&](std::uint32_t v) { return vertex_of_[v]; });
      const Vec3 &a = position(corners[0]), &b = position(corners[1]), &c = position(corners[2]);
      if (a == b || b == c || c == a) continue;
      numbers_.push_back(i);
      triangles_.push_back(corners);
      frames_.push_back(frame(corners));
    }
    neighbors_ = edge_neighbors(triangles_, mesh.positions.size());
    group_of_.resize(3 * triangles_.size(), kNone);
    make_groups();
  }

  [[nodiscard]] std::vector<Vec4> tangents() {
    evaluate();
    std::vector<Vec4> result(3 * mesh_.triangles.size());
    std::vector<std::uint32_t> first_corner(mesh_.positions.size(), kNone);
    std::vector<bool> is_set(mesh_.triangles.size());
    for (std::uint32_t corner = 0; corner < group_of_.size(); ++corner) {
      const std::size_t triangle = numbers_[corner / 3];
      const std::size_t place = 3 * triangle + corner % 3;
      const bool grouped = group_of_[corner] != kNone;
      result[place] = grouped ? tangents_[corner] : tangent_across(normal(vertex(corner)));
      is_set[triangle] = true;
      std::uint32_t& first = first_corner[vertex(corner)];
      if (first == kNone) first = static_cast<std::uint32_t>(place);
    }
    // A triangle with equal vertices takes its tangents from other triangles at these vertices.
    for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
      for (std::size_t k = 0; k < 3 && !is_set[i]; ++k) {
        const std::uint32_t v = vertex_of_[mesh_.triangles[i][k]];
        const std::uint32_t first = first_corner[v];
        result[3 * i + k] = first != kNone ? result[first] : tangent_across(normal(v));
      }
    }
    return result;
  }

 private:
  [[nodiscard]] const Vec3& position(std::uint32_t v) const { return mesh_.positions[v]; }
  [[nodiscard]] const Vec3& normal(std::uint32_t v) const { return mesh_.normals[v]; }
  [[nodiscard]] std::uint32_t vertex(std::uint32_t corner) const {
    return triangles_[corner / 3][corner % 3];
  }

  [[nodiscard]] Frame frame(const std::array<std::uint32_t, 3>& corners) const {
    const auto& [a, b, c] = corners;
    const Vec2 t21 = mesh_.uv[b] - mesh_.uv[a], t31 = mesh_.uv[c] - mesh_.uv[a];
    const Vec3 d1 = position(b) - position(a), d2 = position(c) - position(a);
    const float area = t21.x * t31.y - t21.y * t31.x;  // twice the signed area
    Frame result{.preserves = area > 0};
    if (is_zero(area)) return result;
    const Vec3 s = t31.y * d1 - t21.y * d2, t = t21.x * d2 - t31.x * d1;
    const float s_length = std::sqrt(glm::dot(s, s)), t_length = std::sqrt(glm::dot(t, t));
    const float sign = result.preserves ? 1.0F : -1.0F;
    if (!is_zero(s_length)) result.s = s * (sign / s_length);
    if (!is_zero(t_length)) result.t = t * (sign / t_length);
    result.joins_any = is_zero(s_length / std::abs(area)) || is_zero(t_length / std::abs(area));
    return result;
  }

  void make_groups() {
    for (std::uint32_t corner = 0; corner < group_of_.size(); ++corner) {
      if (group_of_[corner] != kNone || frames_[corner / 3].joins_any) continue;
      grow(corner, group_count_++);
    }
  }

  /// Extends a group from the corner `seed` across the edges that meet at its vertex, first
  /// forward, then backward.
  void grow(std::uint32_t seed, std::uint32_t group) {
    const std::uint32_t center = vertex(seed);
    const bool preserves = frames_[seed / 3].preserves;
    open_.assign(1, seed / 3);
    while (!open_.empty()) {
      const std::uint32_t triangle = open_.back();
      open_.pop_back();
      const auto& corners = triangles_[triangle];
      const auto k =
          static_cast<std::uint32_t>(std::ranges::find(corners, center) - corners.begin());
      const std::uint32_t corner = 3 * triangle + k;
      if (group_of_[corner] != kNone) continue;
      Frame& own = frames_[triangle];
      const std::uint32_t* groups = &group_of_[std::size_t{3} * triangle];
      const bool is_free = groups[0] == kNone && groups[1] == kNone && groups[2] == kNone;
      if (own.joins_any && is_free) own.preserves = preserves;  // the first group decides
      if (own.preserves != preserves) continue;
      group_of_[corner] = group;
      for (const std::uint32_t next :
           {neighbors_[triangle][(k + 2) % 3], neighbors_[triangle][k]}) {
        if (next != kNoNeighbor) open_.push_back(next);
      }
    }
  }

  /// Computes each group's tangent from its corners, in ascending order.
  void evaluate() {
    std::vector<std::uint32_t> first(group_count_ + 1);
    for (const std::uint32_t group : group_of_) {
      if (group != kNone) ++first[group + 1];
    }
    for (std::size_t g = 0; g < group_count_; ++g) first[g + 1] += first[g];
    std::vector<std::uint32_t> members(first.back());
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    for (std::uint32_t corner = 0; corner < group_of_.size(); ++corner) {
      if (group_of_[corner] != kNone) members[next[group_of_[corner]]++] = corner;
    }
    tangents_.resize(group_of_.size());
    for (std::size_t g = 0; g < group_count_; ++g) {
      evaluate({members.data() + first[g], members.data() + first[g + 1]});
    }
  }

  /// A corner's contribution to its group's tangent.
  struct Share {
    Vec3 s, t;  ///< perpendicular to the normal
    double angle;
    bool joins_any;
  };

  void evaluate(std::span<const std::uint32_t> corners) {
    const Vec3& n = normal(vertex(corners.front()));
    const float w = frames_[corners.front() / 3].preserves ? -1.0F : 1.0F;
    shares_.clear();
    for (const std::uint32_t corner : corners) {
      const Frame& own = frames_[corner / 3];
      shares_.push_back({.s = across(own.s, n),
                         .t = across(own.t, n),
                         .angle = own.joins_any ? 0 : angle_at(corner, n),
                         .joins_any = own.joins_any});
    }
    const auto tangent = [&](const auto& counts) {
      DVec3 sum(0);
      for (std::size_t i = 0; i < shares_.size(); ++i) {
        if (!shares_[i].joins_any && counts(i)) sum += shares_[i].angle * DVec3(shares_[i].s);
      }
      const Vec3 s = unit_or_zero(Vec3(sum));
      return is_zero(s) ? tangent_across(n) : Vec4(s, w);
    };
    const Vec4 common = tangent([](std::size_t) { return true; });
    for (const std::uint32_t corner : corners) tangents_[corner] = common;
    if (corners.size() > kMostCompared) return;
    // Opposite tangents cancel, so each corner ignores the corners whose tangents are opposite to
    // its own.
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const auto agrees = [&](std::size_t k) {
        const Share &a = shares_[i], &b = shares_[k];
        return i == k || a.joins_any || b.joins_any ||
               (glm::dot(a.s, b.s) > -1 && glm::dot(a.t, b.t) > -1);
      };
      for (std::size_t k = 0; k < corners.size(); ++k) {
        if (agrees(k)) continue;
        tangents_[corners[i]] = tangent(agrees);
        break;
      }
    }
  }

  /// The triangle's angle at the corner, projected along the normal, in radians.
  [[nodiscard]] double angle_at(std::uint32_t corner, const Vec3& n) const {
    const auto& corners = triangles_[corner / 3];
    const Vec3& here = position(vertex(corner));
    const DVec3 a(across(position(corners[(corner + 2) % 3]) - here, n));
    const DVec3 b(across(position(corners[(corner + 1) % 3]) - here, n));
    const DVec3 difference = a - b, sum = a + b;
    const double tangent_of_half = std::sqrt(glm::dot(difference, difference) / glm::dot(sum, sum));
    return 2 * atan_radians(std::isnan(tangent_of_half) ? 1 : tangent_of_half);
  }

  const TangentSource& mesh_;
  std::vector<std::uint32_t> vertex_of_;  // index of the merged vertex
  // For triangles with three different vertices: indices in the mesh, merged vertices, frames and
  // neighbors.
  std::vector<std::uint32_t> numbers_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::vector<Frame> frames_;
  std::vector<std::array<std::uint32_t, 3>> neighbors_;
  std::vector<std::uint32_t> group_of_;  // by corner of these triangles
  std::vector<Vec4> tangents_;           // by corner, for corners in a group
  std::uint32_t group_count_ = 0;
  std::vector<std::uint32_t> open_;
  std::vector<Share> shares_;
};

}  // namespace

std::vector<Vec4> corner_tangents(const TangentSource& mesh) {
  return Grouping(mesh).tangents();
}

Vec4 tangent_across(const Vec3& normal) {
  const Vec3 n = glm::abs(normal);
  const Vec3 axis = n.x <= n.y && n.x <= n.z ? Vec3(1, 0, 0)
                    : n.y <= n.z             ? Vec3(0, 1, 0)
                                             : Vec3(0, 0, 1);
  const Vec3 tangent = unit_or_zero(axis - normal * glm::dot(normal, axis));
  return {is_zero(tangent) ? axis : tangent, 1};
}

}  // namespace microtrace
