#include "render/bsdf/coating.hpp"

#include "render/bsdf/coating_schlick_table.hpp"

#include <cmath>
#include <cstddef>

namespace microtrace::bsdf {

Coating::Coating(const Layers& layers, const Parameters& base)
    : coat_weight_(layers.coat),
      greatest_sheen_(std::max({layers.sheen.x, layers.sheen.y, layers.sheen.z})),
      sheen_(layers.sheen_roughness),
      coat_(layers.coat_roughness),
      coat_albedo_(coat_),
      coat_frame_(Frame::about(layers.coat_normal)) {
  // A coat with its own normal transmits most along that normal.
  const bool is_turned = layers.coat > 0 && layers.coat_normal != Vec3(0, 0, 1);
  for (std::size_t k = 0; k < kCoatingNodes; ++k) {
    const float z = kCoatingNode[k];
    node_transmittance_[k] = coat_transmittance(is_turned ? 1 : z) * sheen_transmittance(z);
  }
  // The table has no energy deficit for coats with their own normal.
  if (is_turned) return;
  const float row = std::sqrt(base.roughness) * (kCoatingRows - 1);
  const auto first = std::min(static_cast<std::size_t>(row), std::size_t{kCoatingRows - 2});
  const float share = row - static_cast<float>(first);
  // The table's deficit is too large if sheen is narrower than the distance of nodes, and for
  // anisotropic facets.
  float trust = base.anisotropy > 0 ? 0.4F : 1;
  if (greatest_sheen_ > 0) trust *= std::clamp(5 * layers.sheen_roughness - 0.25F, 0.0F, 1.0F);
  const auto mixed = [&](const DeficitTable& table, std::size_t column) {
    float upper = 0, lower = 0;
    for (std::size_t k = 0; k < kCoatingNodes; ++k) {
      upper += node_transmittance_[k] * static_cast<float>(table[first][column][k]);
      lower += node_transmittance_[k] * static_cast<float>(table[first + 1][column][k]);
    }
    return std::max((upper + share * (lower - upper)) * (kDeficitUnit * trust), 0.0F);
  };
  for (std::size_t i = 0; i < kCoatingColumns; ++i)
    deficit_[i] = {.f1 = mixed(kDeficitF1, i), .schlick = mixed(kDeficitSchlick, i)};
}

float Coating::coat_transmittance(const Vec3& w) const {
  return coat_transmittance(std::clamp(coat_frame_.to_local(w).z, 0.0F, 1.0F));
}

float Coating::transmittance(const Vec3& w) const {
  return coat_transmittance(w) * sheen_transmittance(w.z);
}

float Coating::coat_transmittance(float z) const {
  if (coat_weight_ == 0) return 1;
  const Albedo albedo = coat_albedo_.at(z);
  return 1 - coat_weight_ * (kCoat.f0.x * (albedo.f1 - albedo.schlick) + albedo.schlick);
}

float Coating::sheen_transmittance(float z) const {
  return greatest_sheen_ > 0 ? 1 - greatest_sheen_ * sheen_.albedo(z) : 1;
}

Albedo Coating::deficit(float z) const {
  const float step = std::sqrt(z) * (kCoatingColumns - 1);
  const auto first = std::min(static_cast<std::size_t>(step), std::size_t{kCoatingColumns - 2});
  const float share = step - static_cast<float>(first);
  const Albedo &a = deficit_[first], &b = deficit_[first + 1];
  return {.f1 = a.f1 + share * (b.f1 - a.f1),
          .schlick = a.schlick + share * (b.schlick - a.schlick)};
}

}  // namespace microtrace::bsdf
