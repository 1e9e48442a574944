/// The parameters of BSDFs, from materials and their textures.

#include "render/bsdf/base_surface.hpp"
#include "render/shading/shading.hpp"
#include "scene/math/trigonometry.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace microtrace {
namespace {

/// Reflectance at normal incidence of a dielectric with this index of refraction in air. 0 stands
/// for an infinite index.
float head_on_reflectance(float ior) {
  if (ior == 0) return 1;
  const float r = (ior - 1) / (ior + 1);
  return r * r;
}

/// The reflectance of the boundary between two media. Schlick's term approaches 1 at the horizon
/// for any indices of refraction. Between nearly equal indices, which reflect hardly anything at
/// nearly all angles, it is reduced in proportion to the reflectance at normal incidence.
bsdf::Schlick<1> reflectance_between(const Medium& inside, const Medium& outside) {
  const float f0 = head_on_reflectance(inside.ior / outside.ior);
  return {.f0 = Vec3(f0), .f90 = std::min(50 * f0, 1.0F)};
}

}  // namespace

bsdf::Parameters Shading::parameters(const ShadingPoint& point, int channel,
                                     const Medium* outside) {
  const TexturedMaterial& look = *point.look;
  const Material& m = *look.material;
  const Vec4 texel = look[MaterialTexture::metallic_roughness].at(point);
  const bsdf::BaseSurface<1> base(Vec3(base_color(point)), m, texel.y, texel.z);
  bsdf::Parameters p{
      .base_color = base.color, .metallic = base.metallic, .roughness = base.roughness};
  if (m.ior != 1.5F) p.dielectric.f0 = Vec3(head_on_reflectance(m.ior));
  if (outside != nullptr && refracts(m)) p.dielectric = reflectance_between(look.medium, *outside);
  if (const auto& s = m.specular) {
    const float factor = s->factor * look[MaterialTexture::specular].at(point).w;
    const Vec3 color = s->color * Vec3(look[MaterialTexture::specular_color].at(point));
    p.dielectric.f0 = glm::min(p.dielectric.f0 * color, Vec3(1)) * factor;
    p.dielectric.f90 *= factor;
  }
  if (const auto& archived = m.specular_glossiness) {
    const Vec4 t = look[MaterialTexture::specular_glossiness].at(point);
    p.metallic = 0;
    p.roughness = 1 - archived->glossiness * t.w;
    p.dielectric = {.f0 = archived->specular * Vec3(t), .f90 = 1};
  }
  if (m.anisotropy) add_anisotropy(point, p);
  if (const auto& t = m.transmission) {
    p.transmission = t->factor * look[MaterialTexture::transmission].at(point).x;
    if (refracts(m)) {
      float ior = look.medium.ior_of(channel);
      if (outside != nullptr) ior /= outside->ior_of(channel);
      p.eta = point.at.front ? ior : 1 / ior;
    }
  }
  if (const auto& i = m.iridescence) {
    const bsdf::ThinFilm<1> film{
        .share = i->factor * look[MaterialTexture::iridescence].at(point).x,
        .ior = i->ior,
        .thickness = glm::mix(i->thickness_minimum, i->thickness_maximum,
                              look[MaterialTexture::iridescence_thickness].at(point).y)};
    if (film.share > 0 && film.thickness > 0) p.film = film;
  }
  if (const auto& d = m.diffuse_transmission) {
    p.diffuse_transmission = d->factor * look[MaterialTexture::diffuse_transmission].at(point).w;
    p.diffuse_transmission_color =
        d->color * Vec3(look[MaterialTexture::diffuse_transmission_color].at(point));
  }
  return p;
}

void Shading::add_anisotropy(const ShadingPoint& point, bsdf::Parameters& p) {
  const Anisotropy& a = *point.look->material->anisotropy;
  const Vec4 tangent = point.at.tangent();
  if (tangent.w == 0) return;
  Vec2 along(1, 0);
  float strength = a.strength;
  if ((*point.look)[MaterialTexture::anisotropy].map != nullptr) {
    const Vec4 texel = (*point.look)[MaterialTexture::anisotropy].at(point);
    along = 2.0F * Vec2(texel) - Vec2(1);
    strength *= texel.z;
  }
  const auto cosine = static_cast<float>(cos_radians(a.rotation));
  const auto sine = static_cast<float>(sin_radians(a.rotation));
  along = {cosine * along.x - sine * along.y, sine * along.x + cosine * along.y};
  const Vec3 t(tangent), b = tangent.w * glm::cross(point.at.ns, t);
  p.anisotropy = strength;
  p.along = along.x * t + along.y * b;
}

bsdf::Layers Shading::layers(const ShadingPoint& point) {
  const TexturedMaterial& look = *point.look;
  const Material& m = *look.material;
  bsdf::Layers result;
  if (encloses_medium(m))
    result.side = point.at.front ? bsdf::LayerSide::above : bsdf::LayerSide::below;
  if (const auto& sheen = m.sheen) {
    result.sheen = sheen->color * Vec3(look[MaterialTexture::sheen_color].at(point));
    result.sheen_roughness = sheen->roughness * look[MaterialTexture::sheen_roughness].at(point).w;
  }
  if (const auto& coat = m.clearcoat) {
    result.coat = coat->factor * look[MaterialTexture::clearcoat].at(point).x;
    result.coat_roughness =
        coat->roughness * look[MaterialTexture::clearcoat_roughness].at(point).y;
  }
  return result;
}

}  // namespace microtrace
