#include "render/shading/normals.hpp"

#include "render/bsdf/frame.hpp"

#include <algorithm>

#include <glm/geometric.hpp>

namespace microtrace {
namespace {

/// Whether wo is above the horizon of n, and its mirror direction is above the surface with the
/// geometric normal ng.
bool reflects_outwards(const Vec3& n, const Vec3& ng, const Vec3& wo) {
  constexpr float least = 0.01F;
  const float cosine = glm::dot(n, wo);
  return cosine >= least &&
         glm::dot(2 * cosine * n - wo, ng) >= std::min(0.9F * glm::dot(wo, ng), least);
}

}  // namespace

Vec3 mapped_normal(const ShadingPoint& point, const TextureSlot& slot, float scale) {
  const Vec3 n = point.at.ns;
  if (slot.map == nullptr) return n;
  const Vec4 tangent = point.at.tangent();
  if (tangent.w == 0) return n;
  const Vec3 t(tangent), b = tangent.w * glm::cross(n, t);
  const Vec3 v = Vec3(slot.at(point)) * 2.0F - Vec3(1);
  const Vec3 turned = scale * v.x * t + scale * v.y * b + v.z * n;
  return glm::dot(turned, turned) > 0 ? bsdf::unit(turned) : n;
}

Vec3 usable_normal(const Vec3& n, const Vec3& ng, const Vec3& wo) {
  if (reflects_outwards(n, ng, wo)) return n;
  float low = 0, high = 1;
  for (int i = 0; i < 6; ++i) {
    const float middle = (low + high) * 0.5F;
    const bool is_good = reflects_outwards(bsdf::unit(n + middle * (ng - n)), ng, wo);
    (is_good ? high : low) = middle;
  }
  return bsdf::unit(n + high * (ng - n));
}

}  // namespace microtrace
