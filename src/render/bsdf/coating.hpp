#pragma once
/// Transmittance of coatings. Local coordinates as in parameters.hpp.

#include "render/bsdf/coating_table.hpp"
#include "render/bsdf/frame.hpp"
#include "render/bsdf/ggx.hpp"
#include "render/bsdf/layers.hpp"
#include "render/bsdf/parameters.hpp"
#include "render/bsdf/schlick.hpp"
#include "render/bsdf/sheen.hpp"

#include <microtrace/math.hpp>

#include <array>
#include <cstddef>

namespace microtrace::bsdf {

/// Index of refraction 1.5.
inline constexpr Schlick kCoat{};

/// Sheen below a clear coat. The base is scaled by the fraction of light that the layers do not
/// reflect, for wo or wi, whichever is smaller (as in KHR_materials_sheen). Microfacets scatter
/// light into directions of lower transmittance: deficit() is this energy deficit, which the base
/// compensates in other directions.
class Coating {
 public:
  Coating(const Layers& layers, const Parameters& base);

  /// The transmittance of the coat, or of all layers, for a direction above.
  [[nodiscard]] float coat_transmittance(const Vec3& w) const;
  [[nodiscard]] float transmittance(const Vec3& w) const;

  /// The energy deficit for light to or from z = cos(theta): the albedo of the facets if all
  /// directions had the transmittance of z, minus the actual one.
  [[nodiscard]] Albedo deficit(float z) const;

  /// An upper bound of transmittance() at kCoatingNode[k].
  [[nodiscard]] float transmittance_at_node(std::size_t k) const { return node_transmittance_[k]; }

  [[nodiscard]] const SheenLobe& sheen() const { return sheen_; }
  [[nodiscard]] float greatest_sheen() const { return greatest_sheen_; }
  [[nodiscard]] const Ggx& coat() const { return coat_; }
  [[nodiscard]] const Frame& coat_frame() const { return coat_frame_; }

 private:
  [[nodiscard]] float coat_transmittance(float z) const;
  [[nodiscard]] float sheen_transmittance(float z) const;

  float coat_weight_, greatest_sheen_;  // greatest_sheen_: maximum over the channels
  SheenLobe sheen_;
  Ggx coat_;
  GgxAlbedo coat_albedo_;
  Frame coat_frame_;
  std::array<float, kCoatingNodes> node_transmittance_;
  std::array<Albedo, kCoatingColumns> deficit_{};
};

}  // namespace microtrace::bsdf
