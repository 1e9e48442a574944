#pragma once
/// How a surface scatters light: the metallic-roughness model of glTF 2.0, appendix B, and the
/// extensions that change its parts.
///
/// Local coordinates: z is the shading normal on the side of wo. Directions are unit vectors that
/// point away from the surface: wo to where the path comes from, wi to where it goes on, above or
/// below.

#include "render/bsdf/anisotropic_ggx.hpp"
#include "render/bsdf/ggx.hpp"
#include "render/bsdf/schlick.hpp"

#include <microtrace/math.hpp>

#include <optional>

namespace microtrace::bsdf {

/// Over part of a surface (KHR_materials_iridescence).
struct ThinFilm {
  float share = 1;        ///< in [0, 1]
  float ior = 1.3F;       ///< at least 1
  float thickness = 400;  ///< nanometres
};

/// What the textures and factors of a material come to at one point.
struct Parameters {
  Vec3 base_color{1};                 ///< linear Rec. 709, each in [0, 1]
  float metallic = 0, roughness = 1;  ///< each in [0, 1]
  Schlick dielectric{};               ///< of the part that is no metal
  /// Of the light that enters the dielectric: what goes through (KHR_materials_transmission).
  float transmission = 0;
  /// The index of refraction below over that above; nothing: a thin wall, which bends no light.
  std::optional<float> eta{};
  /// Of diffuse light: what goes through, and in which colour (KHR_materials_diffuse_transmission).
  float diffuse_transmission = 0;
  Vec3 diffuse_transmission_color{1};
  /// In [0, 1], and the direction of the longer highlights, of unit length
  /// (KHR_materials_anisotropy).
  float anisotropy = 0;
  Vec2 along{1, 0};
  std::optional<ThinFilm> film{};
};

/// f(wo, wi) |cos(theta_i)|, and the density with which sample() gives wi, per solid angle.
struct Evaluation {
  Vec3 value{0};
  float density = 0;
};

struct DirectionSample {
  Vec3 wi{0, 0, 1};
  Vec3 weight{0};     ///< value / density
  float density = 0;  ///< per solid angle
};

/// Diffuse reflection under specular reflection by GGX with Schlick's Fresnel term. Two things
/// differ from the formulas of section B.3, which lose light on rough metals and return more than
/// comes where dielectrics are seen at a slant: what leaves the facets only after several
/// reflections is added (C. Kulla and A. Conty, Revisiting physically based shading at Imageworks,
/// 2017), and the diffuse part gets what the specular one leaves over in all, to wo and from wi
/// (C. Kelemen and L. Szirmay-Kalos, A microfacet based coupled specular-matte BRDF model with
/// importance sampling, 2001). So it is reciprocal, and white returns all light.
///
/// Light that is refracted (B. Walter et al., Microfacet models for refraction, 2007) is counted
/// without the square of the index: radiance divided by it stays the same on its way in and out. Of
/// rough glass both parts are scaled to return all light (E. Turquin, Practical multiple scattering
/// compensation for microfacet models, 2019), which is not reciprocal.
///
/// Microfacets is Ggx, or AnisotropicGgx: then part of what takes several reflections is left out.
template <typename Microfacets>
class BasicBsdf {
 public:
  /// wo.z > 0.
  BasicBsdf(const Parameters& parameters, const Vec3& wo);

  [[nodiscard]] Evaluation evaluate(const Vec3& wi) const;

  /// u chooses the direction, `lobe`, in [0, 1), the part of the model. Nothing where light is
  /// lost.
  [[nodiscard]] std::optional<DirectionSample> sample(const Vec2& u, float lobe) const;

  /// Whether light can go through.
  [[nodiscard]] bool transmits() const {
    return transmitted_ != Vec3(0) || diffuse_below_ != Vec3(0);
  }

 private:
  [[nodiscard]] Evaluation above(const Vec3& wi, const Vec3& h) const;
  [[nodiscard]] Evaluation below(const Vec3& wi) const;
  /// Of samples at a facet of which wo is seen at that cosine, those that are reflected.
  [[nodiscard]] float reflected_share(const Vec3& fresnel) const;
  [[nodiscard]] Vec3 fresnel(float cosine) const;
  /// Sets what lies under the film; what it reflects head on, about.
  Vec3 add_film();

  /// What the dielectric's specular part leaves over.
  [[nodiscard]] float left_over(const Albedo& albedo) const {
    return 1 - greatest_.albedo(albedo) - returned_ * (1 - albedo.white);
  }

  Vec3 wo_;
  Microfacets ggx_;
  GgxAlbedo albedo_;
  Schlick specular_;  ///< of metal and dielectric together
  std::optional<ThinFilm> film_;
  struct Grey {
    float f0, f90;
    [[nodiscard]] float albedo(const Albedo& a) const {
      return f0 * (a.white - a.edge) + f90 * a.edge;
    }
  } greatest_;      ///< the dielectric's, its brightest channel
  float returned_;  ///< of it after several reflections
  // All that does not depend on wi: diffuse light above and below, several reflections, what goes
  // through.
  Vec3 diffuse_, diffuse_below_, multiple_, transmitted_;
  std::optional<float> eta_;
  float reflected_gain_ = 1;  ///< of single reflections, at walls of rough glass
  // Of samples: by a facet's normal, and of the others those below.
  float facet_share_, below_share_;
};

using Bsdf = BasicBsdf<Ggx>;
using AnisotropicBsdf = BasicBsdf<AnisotropicGgx>;
extern template class BasicBsdf<Ggx>;
extern template class BasicBsdf<AnisotropicGgx>;

}  // namespace microtrace::bsdf
