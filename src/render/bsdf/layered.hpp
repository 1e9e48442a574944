#pragma once
/// Surfaces under sheen under a coat, and such with highlights longer one way than the other. Local
/// coordinates as in bsdf.hpp.

#include "render/bsdf/bsdf.hpp"
#include "render/bsdf/frame.hpp"
#include "render/bsdf/sheen.hpp"

#include <optional>
#include <variant>

namespace microtrace::bsdf {

/// What lies over the base. The defaults are nothing.
struct Layers {
  enum class Side {
    both,   ///< of a thin wall
    above,  ///< where wo is
    below,
  };

  Vec3 sheen{0};              ///< colour, linear Rec. 709, each in [0, 1] (KHR_materials_sheen)
  float sheen_roughness = 0;  ///< in [0, 1]
  float coat = 0, coat_roughness = 0;  ///< each in [0, 1] (KHR_materials_clearcoat)
  Vec3 coat_normal{0, 0, 1};           ///< unit length, above which wo is
  Side side = Side::both;
};

/// A coat lets pass what it does not reflect in all to wo, as KHR_materials_clearcoat has it: no
/// light is lost, and none is won, but wi and wo are no equals. Sheen lets pass what it does not
/// reflect to wo or from wi, whichever is less, as KHR_materials_sheen has it; so do all layers
/// where light goes through.
class LayeredBsdf {
 public:
  /// wo.z > 0.
  LayeredBsdf(const Parameters& base, const Layers& layers, const Vec3& wo);

  [[nodiscard]] Evaluation evaluate(const Vec3& wi) const;

  /// As Bsdf::sample.
  [[nodiscard]] std::optional<DirectionSample> sample(const Vec2& u, float lobe) const;

 private:
  [[nodiscard]] Evaluation base(const Vec3& wi) const;
  void add_sheen(const Vec3& wi, const Vec3& h, Evaluation& e) const;
  void add_coat(const Vec3& wi, const Vec3& h, Evaluation& e) const;
  /// The share of light that passes the coat, the sheen, or all layers, to or from a direction
  /// above.
  [[nodiscard]] float through_coat(const Vec3& w) const;
  [[nodiscard]] float through_sheen(const Vec3& w) const;
  [[nodiscard]] float passed(const Vec3& w) const;

  std::variant<Bsdf, AnisotropicBsdf> base_;
  Layers layers_;
  Vec3 wo_;
  SheenLobe sheen_;
  float greatest_sheen_;  // channel
  Ggx coat_;
  GgxAlbedo coat_albedo_;
  Frame coat_frame_;
  float coat_passed_ = 1, sheen_passed_ = 1;  // to wo
  float sheen_share_ = 0, coat_share_ = 0;    // of samples
};

}  // namespace microtrace::bsdf
