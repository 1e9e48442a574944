#include "accel/build/instances/mesh_tree.hpp"

#include "accel/build/instances/scene_box.hpp"
#include "accel/build/references/reference.hpp"
#include "accel/build/wide/wide_tree.hpp"
#include "scene/mesh/shared_meshes.hpp"

#include <microtrace/primitives.hpp>
#include <microtrace/scene.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace microtrace {
namespace {

constexpr double kUnit = 0x1p-24;  // unit roundoff of float32
constexpr double kGreatestScale = 0x1p16;
/// The errors of smaller coordinates, when a ray is transformed to the mesh, may underflow.
constexpr double kLeastExtent = 0x1p-100;

/// Returns a mesh with the same triangles as a scene of its own.
Scene scene_of(const Mesh& mesh) {
  Scene scene;
  Mesh same;
  // The scene exists only as long as the caller's mesh, whose arrays may have to remain unshared.
  same.positions = Array<Vec3>::borrow({mesh.positions.data(), mesh.positions.size()});
  same.triangles = decltype(mesh.triangles)::borrow({mesh.triangles.data(), mesh.triangles.size()});
  scene.objects.push_back({.name = {}, .shape = std::move(same)});
  return scene;
}

Tree tree_of(const Mesh& mesh, const BuildOptions& options) {
  const Scene scene = scene_of(mesh);
  return build_tree(Primitives(scene),
                    {.fast = options.fast, .threads = options.threads, .keeps_duplicates = true});
}

/// Rows of an approximate inverse of a placement's matrix.
struct Inverse {
  DVec3 rows[3];

  explicit Inverse(const Placement& placement) {
    const DVec3 a = placement.column(0), b = placement.column(1), c = placement.column(2);
    rows[0] = glm::cross(b, c);
    rows[1] = glm::cross(c, a);
    rows[2] = glm::cross(a, b);
    const double factor = 1 / glm::dot(a, rows[0]);
    for (DVec3& row : rows) row *= factor;
  }

  /// True if all elements have errors below 2^-28 times the greatest of their rows.
  [[nodiscard]] bool is_precise(const Placement& placement) const;
};

bool Inverse::is_precise(const Placement& placement) const {
  DVec3 row_max;  // the greatest |component| of each row
  for (int i = 0; i < 3; ++i) {
    const DVec3 size = glm::abs(rows[i]);
    row_max[i] = std::max({size.x, size.y, size.z});
    const bool is_moderate = row_max[i] <= kGreatestScale && row_max[i] >= 1 / kGreatestScale;
    if (!is_moderate) return false;
  }
  // With the residual R = I - B A, the exact inverse is the sum of R^k B. If |R| r <= theta r for
  // the row maxima r, its elements differ from B by at most theta / (1 - theta) r.
  for (int i = 0; i < 3; ++i) {
    double sum = 0;
    for (int k = 0; k < 3; ++k) {
      const DVec3& column = placement.column(k);
      const double residual = (i == k ? 1 : 0) - glm::dot(rows[i], column);
      const double error = 0x1p-50 * (1 + glm::dot(glm::abs(rows[i]), glm::abs(column)));
      sum += (std::abs(residual) + error) * row_max[k];
    }
    if (!(sum <= 0x1p-29 * row_max[i])) return false;
  }
  return true;
}

float float_above(double x) {
  return std::nextafter(static_cast<float>(x), std::numeric_limits<float>::infinity());
}

/// Returns an instance without what make_instance() computes.
Instance placed(const Placement& placement) {
  Instance instance{};
  instance.scene_from_mesh = &placement.column(0).x;
  instance.is_mirrored = placement.is_mirrored() ? 1 : 0;
  return instance;
}

double greatest(const Vec3& lo, const Vec3& hi, int axis, double from = 0) {
  return std::max(std::abs(double{lo[axis]} - from), std::abs(double{hi[axis]} - from));
}

}  // namespace

OwnedMeshTree::OwnedMeshTree(const Mesh& mesh, const BuildOptions& options)
    : tree(tree_of(mesh, options)),
      view{.nodes = tree.nodes.data(),
           .blocks = tree.blocks.data(),
           .others = tree.others.data(),
           .root = tree.root,
           .triangles = static_cast<std::uint32_t>(mesh.triangles.size())} {
  // The only owner of an array may still change it by a reference that edit() returned.
  if (!mesh.positions.is_shared() || !mesh.triangles.is_shared()) return;
  positions = mesh.positions;
  triangles = mesh.triangles;
}

bool OwnedMeshTree::is_of(const Mesh& mesh) const {
  return !positions.empty() && ArrayKey(positions) == ArrayKey(mesh.positions) &&
         ArrayKey(triangles) == ArrayKey(mesh.triangles);
}

std::optional<build::Box> build::instance_box(const OwnedMeshTree& tree, const PlacedMesh& mesh) {
  const Placement& placement = *mesh.placement;
  if (!Inverse(placement).is_precise(placement)) return std::nullopt;
  const Box box = scene_box(placed(placement), tree.tree, mesh);
  if (!fits_blocks(box)) return std::nullopt;
  const Bounds in_scene = bounds_of(box), &in_mesh = tree.tree.bounds;
  double extent = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (!(greatest(in_mesh.lo, in_mesh.hi, axis) <= kLargestInBlocks &&
          std::abs(placement.column(3)[axis]) <= kLargestInBlocks))
      return std::nullopt;
    extent = std::max(extent, greatest(in_scene.lo, in_scene.hi, axis));
  }
  return extent < kLeastExtent ? std::nullopt : std::optional(box);
}

Instance build::make_instance(const Tree& of_mesh, const Placement& placement, const Box& box) {
  const Inverse inverse(placement);
  const Bounds in_scene = bounds_of(box), &in_mesh = of_mesh.bounds;
  double reach = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double t = placement.column(3)[axis];
    double size = std::abs(t);
    for (int k = 0; k < 3; ++k)
      size += std::abs(placement.column(k)[axis]) * greatest(in_mesh.lo, in_mesh.hi, k);
    // The rounding of vertices, and the part of rho.
    const double rounding =
        1.01 * kUnit * greatest(in_scene.lo, in_scene.hi, axis) + 0x1p-49 * size + 0x1p-140;
    reach += 1.2 * rounding + 5 * kUnit * greatest(in_scene.lo, in_scene.hi, axis, t);
  }
  Instance instance = placed(placement);
  instance.reach = float_above(reach * (1 + 0x1p-20));
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k)
      instance.mesh_from_scene[i][k] = static_cast<float>(inverse.rows[i][k]);
  return instance;
}

}  // namespace microtrace
