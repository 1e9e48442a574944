#pragma once
/// Any surface, bare or under layers. Local coordinates as in parameters.hpp.

#include "render/bsdf/cover.hpp"
#include "render/bsdf/general.hpp"
#include "render/bsdf/layers.hpp"

#include <optional>
#include <variant>

namespace microtrace::bsdf {

/// A GeneralBsdf under sheen under a clear coat. Where light is bent, layers lie on the outside
/// only, and some of what comes from within is lost in them.
class LayeredBsdf {
 public:
  /// wo.z > 0.
  LayeredBsdf(const Parameters& base, const std::optional<Layers>& layers, const Vec3& wo);

  [[nodiscard]] Evaluation evaluate(const Vec3& wi) const;

  /// As Bsdf::sample.
  [[nodiscard]] std::optional<DirectionSample> sample(const Vec2& u, float lobe) const;

 private:
  struct Over {
    Layers layers;
    Cover cover;
    float passed = 1;                       // to wo
    float sheen_share = 0, coat_share = 0;  // of samples
  };

  /// What the base is told of the layers.
  [[nodiscard]] const Cover* cover() const {
    return over_ && over_->layers.side == Layers::Side::both ? &over_->cover : nullptr;
  }
  [[nodiscard]] Evaluation base(const Vec3& wi) const;
  void add_sheen(const Vec3& wi, const Vec3& h, Evaluation& e) const;
  void add_coat(const Vec3& wi, const Vec3& h, Evaluation& e) const;

  Vec3 wo_;
  std::optional<Over> over_;
  std::variant<GeneralBsdf<Ggx>, GeneralBsdf<AnisotropicGgx>> base_;
};

}  // namespace microtrace::bsdf
