/// Light that crosses thin smooth walls in straight lines.

#include "render/bsdf/bsdf.hpp"
#include "render/bsdf/put_surface.hpp"
#include "render/shading/points/normals.hpp"
#include "render/shading/shading.hpp"

#include <algorithm>
#include <optional>

namespace microtrace {

Vec3 Shading::normal(const ShadingPoint& point, const Vec3& d, MaterialTexture texture,
                     float scale) {
  const TextureSlot& slot = (*point.look)[texture];
  const float side = point.at.front ? 1.0F : -1.0F;
  Vec3 n = point.at.ns;
  if (slot.map != nullptr) {
    const Vec4 tangent = point.at.tangent();
    n = mapped_normal<1>(n, {Vec3(tangent), tangent.w}, Vec3(slot.at(point)), scale);
  }
  return usable_normal<1>(side * n, side * point.at.n, -d);
}

Vec3 Shading::normal(const ShadingPoint& point, const Vec3& d) {
  return normal(point, d, MaterialTexture::normal, point.look->material->normal_scale);
}

Vec3 Shading::crossing_light(const ShadingPoint& point, const Vec3& d, BsdfModel model) const {
  std::optional<BsdfInput> varying;
  const BsdfInput& input = bsdf_input(point, 3, nullptr, varying);
  const Vec3 wi = unit<1>(d);
  const auto frame = bsdf::Frame<1>::about(normal(point, wi));
  Vec3 wo = frame.to_local(-wi);
  wo.z = std::max(wo.z, bsdf::kGrazingCosine);
  const auto& coat = point.look->material->clearcoat;
  const Vec3 coat_normal =
      coat ? normal(point, wi, MaterialTexture::clearcoat_normal, coat->normal_scale) : frame.n;
  const bsdf::Surface<1> surface =
      bsdf::surface_of(input.parameters, input.layers, coat_normal, frame);
  bsdf::Features features = input.features;
  features.is_spec = model == BsdfModel::spec;
  std::optional<bsdf::Coating<1>> coating;
  if (features.layers != bsdf::LayerSide::none) coating.emplace(surface);
  const bsdf::Bsdf<1, bsdf::IsotropicParts<1>> bsdf(features, surface,
                                                    coating ? &*coating : nullptr, wo);
  return bsdf.crossing_light();
}

Vec3 Shading::transmittance(const ShadingPoint& point, const Vec3& d, BsdfModel model) const {
  const float coverage = this->coverage(point, false);
  if (!point.look->is_clear || coverage == 0) return Vec3(1 - coverage);
  return (1 - coverage) + coverage * crossing_light(point, d, model);
}

Vec3 Shading::masked_transmittance(const Ray& ray, PrimitiveId id, BsdfModel model) const {
  if (!look_of(id).is_clear) return Vec3(1 - masked_coverage(ray, id));
  return transmittance(point(ray, {.id = id, .t = 0}).unfiltered(), ray.d, model);
}

}  // namespace microtrace
