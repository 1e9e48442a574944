#pragma once
/// How much of light layers let pass. Local coordinates as in parameters.hpp.

#include "render/bsdf/cover_table.hpp"
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

/// Of index of refraction 1.5.
inline constexpr Schlick kCoat{};

/// Sheen under a clear coat. What lies below gets what they do not reflect in all, to wo or from
/// wi, whichever is less (as KHR_materials_sheen has it). Facets turn light to where less passes:
/// missed() is how much of it that costs, for what lies below to return it elsewhere.
class Cover {
 public:
  Cover(const Layers& layers, const Parameters& base);

  /// The share of light that passes the coat, or all, to or from a direction above.
  [[nodiscard]] float through_coat(const Vec3& w) const;
  [[nodiscard]] float passed(const Vec3& w) const;

  /// Of light to or from z = cos(theta) that facets would return if all passed that passes there:
  /// what does not.
  [[nodiscard]] Albedo missed(float z) const;

  /// passed() at kCoverNode, or more.
  [[nodiscard]] float passed_at_node(std::size_t k) const { return node_passed_[k]; }

  [[nodiscard]] const SheenLobe& sheen() const { return sheen_; }
  [[nodiscard]] float greatest_sheen() const { return greatest_sheen_; }
  [[nodiscard]] const Ggx& coat() const { return coat_; }
  [[nodiscard]] const Frame& coat_frame() const { return coat_frame_; }

 private:
  [[nodiscard]] float through_coat(float z) const;
  [[nodiscard]] float through_sheen(float z) const;

  float coat_share_, greatest_sheen_;  // the latter of the channels
  SheenLobe sheen_;
  Ggx coat_;
  GgxAlbedo coat_albedo_;
  Frame coat_frame_;
  std::array<float, kCoverNodes> node_passed_;
  std::array<Albedo, kCoverColumns> missed_{};
};

}  // namespace microtrace::bsdf
