#include "render/shading/shading.hpp"
#include "scene/math/trigonometry.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace microtrace {

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
