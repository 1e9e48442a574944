#pragma once
/// The BSDF of any surface, with or without layers. Local coordinates as in parameters.hpp.

#include "render/bsdf/coating.hpp"
#include "render/bsdf/general.hpp"
#include "render/bsdf/layers.hpp"

#include <optional>
#include <variant>

namespace microtrace::bsdf {

/// A GeneralBsdf below sheen below a clear coat. On refracting surfaces the layers are only on the
/// outside, and absorb part of the light from inside.
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
    Coating coating;
    float transmittance = 1;                            // transmittance for wo
    float sheen_probability = 0, coat_probability = 0;  // sampling probabilities
  };

  /// The coating that the base takes into account.
  [[nodiscard]] const Coating* coating() const {
    return over_ && over_->layers.side == Layers::Side::both ? &over_->coating : nullptr;
  }
  [[nodiscard]] Evaluation base(const Vec3& wi) const;
  void add_sheen(const Vec3& wi, const Vec3& h, Evaluation& e) const;
  void add_coat(const Vec3& wi, const Vec3& h, Evaluation& e) const;

  Vec3 wo_;
  std::optional<Over> over_;
  std::variant<GeneralBsdf<Ggx>, GeneralBsdf<AnisotropicGgx>> base_;
};

}  // namespace microtrace::bsdf
