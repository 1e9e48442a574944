#include "render/bsdf/cover.hpp"

#include "render/bsdf/cover_edge_table.hpp"

#include <cmath>
#include <cstddef>

namespace microtrace::bsdf {

Cover::Cover(const Layers& layers, const Parameters& base)
    : coat_share_(layers.coat),
      greatest_sheen_(std::max({layers.sheen.x, layers.sheen.y, layers.sheen.z})),
      sheen_(layers.sheen_roughness),
      coat_(layers.coat_roughness),
      coat_albedo_(coat_),
      coat_frame_(Frame::about(layers.coat_normal)) {
  // A coat that is turned lets pass where it is met head on most.
  const bool is_turned = layers.coat > 0 && layers.coat_normal != Vec3(0, 0, 1);
  for (std::size_t k = 0; k < kCoverNodes; ++k) {
    const float z = kCoverNode[k];
    node_passed_[k] = through_coat(is_turned ? 1 : z) * through_sheen(z);
  }
  // The table does not tell what is missed there.
  if (is_turned) return;
  const float row = std::sqrt(base.roughness) * (kCoverRows - 1);
  const auto first = std::min(static_cast<std::size_t>(row), std::size_t{kCoverRows - 2});
  const float share = row - static_cast<float>(first);
  // It tells too much where sheen is narrower than the nodes are apart, and of facets that are
  // longer one way.
  float trust = base.anisotropy > 0 ? 0.4F : 1;
  if (greatest_sheen_ > 0) trust *= std::clamp(5 * layers.sheen_roughness - 0.25F, 0.0F, 1.0F);
  const auto mixed = [&](const MissedTable& table, std::size_t column) {
    float upper = 0, lower = 0;
    for (std::size_t k = 0; k < kCoverNodes; ++k) {
      upper += node_passed_[k] * static_cast<float>(table[first][column][k]);
      lower += node_passed_[k] * static_cast<float>(table[first + 1][column][k]);
    }
    return std::max((upper + share * (lower - upper)) * (kMissedUnit * trust), 0.0F);
  };
  for (std::size_t i = 0; i < kCoverColumns; ++i)
    missed_[i] = {.white = mixed(kMissedWhite, i), .edge = mixed(kMissedEdge, i)};
}

float Cover::through_coat(const Vec3& w) const {
  return through_coat(std::clamp(coat_frame_.to_local(w).z, 0.0F, 1.0F));
}

float Cover::passed(const Vec3& w) const {
  return through_coat(w) * through_sheen(w.z);
}

float Cover::through_coat(float z) const {
  if (coat_share_ == 0) return 1;
  const Albedo albedo = coat_albedo_.at(z);
  return 1 - coat_share_ * (kCoat.f0.x * (albedo.white - albedo.edge) + albedo.edge);
}

float Cover::through_sheen(float z) const {
  return greatest_sheen_ > 0 ? 1 - greatest_sheen_ * sheen_.albedo(z) : 1;
}

Albedo Cover::missed(float z) const {
  const float step = std::sqrt(z) * (kCoverColumns - 1);
  const auto first = std::min(static_cast<std::size_t>(step), std::size_t{kCoverColumns - 2});
  const float share = step - static_cast<float>(first);
  const Albedo &a = missed_[first], &b = missed_[first + 1];
  return {.white = a.white + share * (b.white - a.white),
          .edge = a.edge + share * (b.edge - a.edge)};
}

}  // namespace microtrace::bsdf
