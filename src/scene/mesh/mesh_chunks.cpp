#include "scene/mesh/mesh_chunks.hpp"

#include "scene/support.hpp"

#include <limits>

#include <glm/common.hpp>

namespace microtrace {
namespace {

constexpr MeshChunks::Box kEmptyBox{.lo = Vec3(std::numeric_limits<float>::infinity()),
                                    .hi = Vec3(-std::numeric_limits<float>::infinity())};

// Rounded sums and products with a constant are monotonic, so the images of vertices are between
// those of two corners that the signs of the matrix select.
MeshChunks::Box placed_box(const MeshChunks::Box& box, const Placement& placement) {
  if (!(box.lo.x <= box.hi.x)) return kEmptyBox;
  MeshChunks::Box result;
  for (int axis = 0; axis < 3; ++axis) {
    DVec3 low, high;
    for (int k = 0; k < 3; ++k) {
      const bool descends = placement.column(k)[axis] < 0;
      low[k] = descends ? box.hi[k] : box.lo[k];
      high[k] = descends ? box.lo[k] : box.hi[k];
    }
    result.lo[axis] = static_cast<float>(placement.coordinate(axis, low));
    result.hi[axis] = static_cast<float>(placement.coordinate(axis, high));
  }
  return result;
}

}  // namespace

MeshChunks::MeshChunks(const Mesh& mesh)
    : boxes_((mesh.positions.size() + kSize - 1) / kSize, kEmptyBox) {
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const Vec3& p = mesh.positions[i];
    if (!is_finite(p)) continue;
    Box& box = boxes_[i / kSize];
    box.lo = glm::min(box.lo, p);
    box.hi = glm::max(box.hi, p);
  }
}

std::vector<MeshChunks::Box> MeshChunks::placed(const Placement& placement) const {
  std::vector<Box> boxes;
  boxes.reserve(boxes_.size());
  for (const Box& box : boxes_) boxes.push_back(placed_box(box, placement));
  return boxes;
}

std::vector<std::size_t> MeshChunks::farthest(const std::vector<Box>& boxes) {
  std::vector<std::size_t> chunks;
  if (boxes.empty()) return chunks;
  const auto index_of = [&](const auto& box) {
    return static_cast<std::size_t>(box - boxes.begin());
  };
  for (int axis = 0; axis < 3; ++axis) {
    chunks.push_back(index_of(
        std::ranges::min_element(boxes, {}, [axis](const Box& box) { return box.lo[axis]; })));
    chunks.push_back(index_of(
        std::ranges::max_element(boxes, {}, [axis](const Box& box) { return box.hi[axis]; })));
  }
  return chunks;
}

}  // namespace microtrace
