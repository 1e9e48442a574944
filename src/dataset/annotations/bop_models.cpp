#include "dataset/annotations/bop_models.hpp"

#include "base/little_endian.hpp"
#include "dataset/annotations/bop_names.hpp"
#include "dataset/annotations/json_text.hpp"
#include "dataset/annotations/mesh_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <variant>

namespace microtrace::dataset {
namespace {

double squared_distance(const DVec3& a, const DVec3& b) {
  const DVec3 way = a - b;
  return way.x * way.x + way.y * way.y + way.z * way.z;
}

/// A tree of points. The search for the most distant pair leaves out pairs of nodes whose boxes are
/// too close together.
class PointTree {
 public:
  explicit PointTree(std::span<const DVec3> points) : points_(points.begin(), points.end()) {
    if (!points_.empty()) build(0, points_.size());
  }

  [[nodiscard]] double largest_squared_distance() {
    if (!nodes_.empty()) search(0, 0);
    return best_;
  }

 private:
  struct Node {
    std::size_t first, last;
    DVec3 low, high;
    std::size_t left = 0, right = 0;  // 0 for leaves
  };

  std::size_t build(std::size_t first, std::size_t last) {
    constexpr std::size_t kLeaf = 16;
    Node node{.first = first, .last = last, .low = points_[first], .high = points_[first]};
    for (std::size_t i = first; i < last; ++i) {
      node.low = glm::min(node.low, points_[i]);
      node.high = glm::max(node.high, points_[i]);
    }
    const std::size_t index = nodes_.size();
    nodes_.push_back(node);
    if (last - first <= kLeaf) return index;
    const DVec3 size = node.high - node.low;
    const glm::length_t axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t middle = first + (last - first) / 2;
    const auto at = [&](std::size_t i) { return points_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(first), at(middle), at(last),
                     [&](const DVec3& a, const DVec3& b) { return a[axis] < b[axis]; });
    const std::size_t left = build(first, middle), right = build(middle, last);
    nodes_[index].left = left;
    nodes_[index].right = right;
    return index;
  }

  /// Returns an upper bound of the squared distances between the points of two nodes.
  [[nodiscard]] double bound(std::size_t a, std::size_t b) const {
    const Node &p = nodes_[a], &q = nodes_[b];
    return squared_distance(glm::max(p.high - q.low, q.high - p.low), DVec3(0));
  }

  void search(std::size_t a, std::size_t b) {
    if (bound(a, b) <= best_) return;
    const Node &p = nodes_[a], &q = nodes_[b];
    if (p.left == 0 && q.left == 0) {
      for (std::size_t i = p.first; i < p.last; ++i) {
        for (std::size_t j = q.first; j < q.last; ++j)
          best_ = std::max(best_, squared_distance(points_[i], points_[j]));
      }
      return;
    }
    if (a == b) {
      search(p.left, p.right);
      search(p.left, p.left);
      search(p.right, p.right);
      return;
    }
    const bool splits_a = q.left == 0 || (p.left != 0 && p.last - p.first >= q.last - q.first);
    const Node& split = splits_a ? p : q;
    const auto bound_of = [&](std::size_t child) {
      return splits_a ? bound(child, b) : bound(a, child);
    };
    std::array children{split.left, split.right};
    if (bound_of(children[0]) < bound_of(children[1])) std::swap(children[0], children[1]);
    for (const std::size_t child : children) splits_a ? search(child, b) : search(a, child);
  }

  std::vector<DVec3> points_;
  std::vector<Node> nodes_;
  double best_ = 0;
};

std::string ply_header(std::size_t points, std::size_t triangles, bool has_normals) {
  std::string text = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                     std::to_string(points) +
                     "\nproperty float x\nproperty float y\nproperty float z\n";
  if (has_normals) text += "property float nx\nproperty float ny\nproperty float nz\n";
  return text + "element face " + std::to_string(triangles) +
         "\nproperty list uchar int vertex_indices\nend_header\n";
}

void append_vector(std::string& bytes, const Vec3& v) {
  append_little(bytes, v.x);
  append_little(bytes, v.y);
  append_little(bytes, v.z);
}

}  // namespace

double diameter(std::span<const DVec3> points) {
  return std::sqrt(PointTree(points).largest_squared_distance());
}

std::optional<BopModel> bop_model(const Scene& scene, std::uint32_t object, const BopFrames& frames,
                                  const BopOptions& options) {
  const Shape& shape = scene.objects.at(object).shape;
  const std::vector<Vec3> positions = mesh_points(shape);
  if (positions.empty()) return std::nullopt;
  const auto* mesh = std::get_if<Mesh>(&shape);
  const bool has_normals = mesh != nullptr && !mesh->normals.empty();
  using Corners = std::array<std::uint32_t, 3>;
  std::vector<Corners> triangles{{0, 1, 2}};
  if (mesh != nullptr) {
    triangles.resize(mesh->triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i) triangles[i] = mesh->corners(i);
  }

  std::string ply = ply_header(positions.size(), triangles.size(), has_normals);
  std::vector<Vec3> stored;
  stored.reserve(positions.size());
  for (const Vec3& p : positions)
    stored.emplace_back((DVec3(p) - frames.origin(object)) * options.millimeters_per_unit);
  const std::vector<DVec3> points(stored.begin(), stored.end());
  DVec3 low(std::numeric_limits<double>::infinity()), high = -low;
  for (std::size_t i = 0; i < points.size(); ++i) {
    append_vector(ply, stored[i]);
    if (has_normals) append_vector(ply, mesh->normal(i));
    low = glm::min(low, points[i]);
    high = glm::max(high, points[i]);
  }
  for (const Corners& corners : triangles) {
    ply += '\3';
    for (const std::uint32_t corner : corners) append_little(ply, corner);
  }

  BopModel model;
  model.id = options.first_object_id + object;
  model.file = {.name = "models/obj_" + six_digits(model.id) + ".ply", .bytes = std::move(ply)};
  const DVec3 size = high - low;
  model.info = "\"" + std::to_string(model.id) + "\": " +
               JsonText('{')
                   .member("diameter", diameter(points))
                   .member("min_x", low.x)
                   .member("min_y", low.y)
                   .member("min_z", low.z)
                   .member("size_x", size.x)
                   .member("size_y", size.y)
                   .member("size_z", size.z)
                   .text();
  return model;
}

std::string bop_models_info(std::span<const BopModel> models) {
  std::string text = "{";
  std::string_view separator = "\n  ";
  for (const BopModel& model : models) {
    text.append(separator).append(model.info);
    separator = ",\n  ";
  }
  return text + "\n}\n";
}

}  // namespace microtrace::dataset
