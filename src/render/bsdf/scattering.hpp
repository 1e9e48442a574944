#pragma once
/// The BSDF of any material.

#include "render/bsdf/bsdf.hpp"
#include "render/bsdf/layered.hpp"

#include <optional>
#include <variant>

namespace microtrace::bsdf {

/// Uses Bsdf if it is sufficient, as for most materials.
class Scattering {
 public:
  /// wo.z > 0.
  Scattering(const Parameters& parameters, const std::optional<Layers>& layers, const Vec3& wo)
      : model_(model(parameters, layers, wo)) {}

  [[nodiscard]] Evaluation evaluate(const Vec3& wi) const {
    if (const auto* plain = std::get_if<Bsdf>(&model_)) return plain->evaluate(wi);
    return std::get<LayeredBsdf>(model_).evaluate(wi);
  }

  /// As Bsdf::sample.
  [[nodiscard]] std::optional<DirectionSample> sample(const Vec2& u, float lobe) const {
    if (const auto* plain = std::get_if<Bsdf>(&model_)) return plain->sample(u, lobe);
    return std::get<LayeredBsdf>(model_).sample(u, lobe);
  }

 private:
  using Model = std::variant<Bsdf, LayeredBsdf>;

  static Model model(const Parameters& parameters, const std::optional<Layers>& layers,
                     const Vec3& wo) {
    if (!layers && parameters.is_plain()) return Bsdf(parameters, wo);
    return LayeredBsdf(parameters, layers, wo);
  }

  Model model_;
};

}  // namespace microtrace::bsdf
