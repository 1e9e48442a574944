#include "render/bsdf/layered.hpp"
#include "render/shading/normals.hpp"
#include "render/shading/shading.hpp"
#include "scene/trigonometry.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace microtrace {

void Shading::add_anisotropy(const ShadingPoint& point, const bsdf::Frame& frame,
                             bsdf::Parameters& p) {
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
  const Vec2 local(frame.to_local(along.x * t + along.y * b));
  const float square = glm::dot(local, local);
  if (!(square > 0)) return;
  p.anisotropy = strength;
  p.along = local / std::sqrt(square);
}

std::optional<bsdf::Layers> Shading::layers(const ShadingPoint& point, const bsdf::Frame& frame,
                                            const Vec3& wo) const {
  const TexturedMaterial& look = *point.look;
  const Material& m = *look.material;
  if (!m.clearcoat && !m.sheen) return std::nullopt;
  bsdf::Layers result;
  if (encloses_medium(m)) {
    result.side = point.at.front ? bsdf::Layers::Side::above : bsdf::Layers::Side::below;
  }
  if (const auto& sheen = m.sheen) {
    result.sheen = sheen->color * Vec3(look[MaterialTexture::sheen_color].at(point));
    result.sheen_roughness = sheen->roughness * look[MaterialTexture::sheen_roughness].at(point).w;
  }
  if (const auto& coat = m.clearcoat) {
    result.coat = coat->factor * look[MaterialTexture::clearcoat].at(point).x;
    result.coat_roughness =
        coat->roughness * look[MaterialTexture::clearcoat_roughness].at(point).y;
    const Vec3 n =
        mapped_normal(point, look[MaterialTexture::clearcoat_normal], coat->normal_scale);
    const float side = point.at.front ? 1.0F : -1.0F;
    result.coat_normal = frame.to_local(usable_normal(side * n, side * point.at.n, wo));
  }
  if (result.coat == 0 && result.sheen == Vec3(0)) return std::nullopt;
  return result;
}

}  // namespace microtrace
