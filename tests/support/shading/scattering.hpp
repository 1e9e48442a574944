#pragma once
/// Evaluates BSDFs for single points, by the one-lane instances of the BSDF templates.

#include "render/bsdf/bsdf.hpp"
#include "render/bsdf/parameters.hpp"
#include "render/bsdf/put_surface.hpp"

#include <memory>
#include <optional>
#include <utility>
#include <variant>

namespace microtrace::bsdf {

/// Returns the surface with these parameters, in local shading coordinates.
inline Surface<1> surface_of(const Parameters& parameters, const Layers& layers = {},
                             const Vec3& coat_normal = {0, 0, 1}) {
  return surface_of(parameters, layers, coat_normal, Frame<1>::about({0, 0, 1}));
}

struct DirectionSample {
  Vec3 wi{0, 0, 1};
  Vec3 weight{0};  ///< value / pdf
  float pdf = 0;   ///< per solid angle
};

template <class Model>
std::optional<DirectionSample> sample_of(const Model& model, const Vec2& u, float lobe) {
  const auto [wi, e] = model.sample(u, lobe);
  if (!(e.pdf > 0)) return std::nullopt;
  return DirectionSample{.wi = wi, .weight = e.value / e.pdf, .pdf = e.pdf};
}

/// A BSDF with only those features that the parameters need, as chosen for the vertices of paths.
class Scattering {
 public:
  /// All directions are in local coordinates. wo.z must be positive.
  Scattering(const Parameters& parameters, const std::optional<Layers>& layers, const Vec3& wo,
             const Vec3& coat_normal = {0, 0, 1})
      : Scattering(features_of(parameters, layers.value_or(Layers{})),
                   surface_of(parameters, layers.value_or(Layers{}), coat_normal), wo) {}
  Scattering(const Features& features, const Surface<1>& surface, const Vec3& wo)
      : coating_(features.layers == LayerSide::none ? nullptr
                                                    : std::make_shared<Coating<1>>(surface)),
        model_(model(features, surface, coating_.get(), wo)) {}
  /// A BSDF without layers.
  Scattering(const Parameters& parameters, const Vec3& wo)
      : Scattering(parameters, std::nullopt, wo) {}

  [[nodiscard]] Evaluation<1> evaluate(const Vec3& wi) const {
    return std::visit([&](const auto& model) { return model.evaluate(wi); }, model_);
  }
  [[nodiscard]] std::optional<DirectionSample> sample(const Vec2& u, float lobe) const {
    return std::visit([&](const auto& model) { return sample_of(model, u, lobe); }, model_);
  }

 private:
  using Model = std::variant<Bsdf<1, PlainParts<1>>, Bsdf<1, IsotropicParts<1>>,
                             Bsdf<1, AnisotropicParts<1>>>;

  static Model model(const Features& features, const Surface<1>& surface, const Coating<1>* coating,
                     const Vec3& wo) {
    if (features.is_anisotropic)
      return Bsdf<1, AnisotropicParts<1>>(features, surface, coating, wo);
    if (features.index() == 0 && !features.is_spec)
      return Bsdf<1, PlainParts<1>>({}, surface, nullptr, wo);
    return Bsdf<1, IsotropicParts<1>>(features, surface, coating, wo);
  }

  std::shared_ptr<const Coating<1>> coating_;
  Model model_;
};

}  // namespace microtrace::bsdf
