#include "render/lights/lighting.hpp"

#include "render/lights/punctual.hpp"
#include "render/sampling/warps.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace microtrace {
namespace {

float luminance(const Vec3& c) {
  return 0.2126F * c.x + 0.7152F * c.y + 0.0722F * c.z;
}

Vec3 corner_weights(const Vec2& u) {
  const Vec2 w = sampling::triangle_weights(u);
  return {w.x, w.y, std::max(1 - w.x - w.y, 0.0F)};
}

double area_of(const Triangle& t) {
  const DVec3 n = glm::cross(DVec3(t.b) - DVec3(t.a), DVec3(t.c) - DVec3(t.a));
  return std::sqrt(glm::dot(n, n)) / 2;
}

}  // namespace

Lighting::Lighting(const Scene& scene, const Primitives& primitives, const Shading& shading)
    : scene_(scene), primitives_(primitives), shading_(shading) {
  if (scene.environment) {
    environment_.emplace(*scene.environment);
  } else if (scene.lights.empty()) {
    environment_.emplace(Environment{.content = Studio{}});
  }
  add_triangles(shading);
  add_lights();
  double sum = 0;
  for (const float power : powers_) sums_.push_back(static_cast<float>(sum += power));
  if (environment_ && !environment_->is_uniform())
    environment_share_ = emitters_.empty() ? 1 : 0.5F;
}

void Lighting::add_triangles(const Shading& shading) {
  PrimitiveId id = 0;
  for (const Object& object : scene_.objects) {
    const std::size_t count = primitive_count(object.shape);
    const Material& material = material_of(scene_, object);
    const auto* mesh = std::get_if<Mesh>(&object.shape);
    const bool shines = mesh != nullptr && material.emissive != Vec3(0) && !material.unlit;
    for (std::size_t i = 0; shines && i < count; ++i) {
      const auto number = static_cast<PrimitiveId>(id + i);
      const auto area = static_cast<float>(area_of(triangle_of(*mesh, i)));
      // Filtered over about the triangle.
      const ShadingPoint middle =
          shading.point_on(number, Vec3(1 / 3.0F), true, std::sqrt(area) * 0.75F);
      const float power = area * luminance(shading.emission(middle)) *
                          (material.double_sided ? 2.0F : 1.0F) / bsdf::kInversePi;
      if (!(power > 0)) continue;
      emitters_.push_back({.id = number, .light = kNone, .area = area});
      powers_.push_back(power);
    }
    id += static_cast<PrimitiveId>(count);
  }
  triangles_ = emitters_.size();
}

void Lighting::add_lights() {
  for (std::uint32_t i = 0; i < scene_.lights.size(); ++i) {
    const float power = punctual_power(scene_.lights[i].light);
    if (!(power > 0)) continue;
    emitters_.push_back({.id = 0, .light = i, .area = 0});
    powers_.push_back(power);
  }
}

float Lighting::share(std::size_t emitter) const {
  return (1 - environment_share_) * powers_[emitter] / sums_.back();
}

std::optional<LightSample> Lighting::of_triangle(const Emitter& emitter, const Vec3& p,
                                                 const Vec2& u) const {
  const Vec3 weights = corner_weights(u);
  ShadingPoint point = shading_.point_on(emitter.id, weights, true, 0);
  const Vec3 way = point.at.p - p;
  const float square = glm::dot(way, way);
  if (!(square > 0)) return std::nullopt;
  const Vec3 wi = way / std::sqrt(square);
  const float cosine = -glm::dot(wi, point.at.n);
  point.at.front = cosine > 0;
  if (cosine == 0 || (!point.at.front && !point.look->material->double_sided)) return std::nullopt;
  const float density = square / (emitter.area * std::abs(cosine));
  return LightSample{.way = way,
                     .wi = wi,
                     .light = shading_.emission(point) / density,
                     .density = density,
                     .target = emitter.id};
}

std::optional<LightSample> Lighting::sample(const Vec3& p, const Vec2& u, float choice) const {
  if (choice < environment_share_) {
    const EnvironmentLight::Sample s = environment_->sample(u);
    if (!(s.pdf > 0)) return std::nullopt;
    const float density = s.pdf * environment_share_;
    return LightSample{
        .way = s.wi, .is_far = true, .wi = s.wi, .light = s.radiance / density, .density = density};
  }
  if (emitters_.empty()) return std::nullopt;
  const float rest = (choice - environment_share_) / (1 - environment_share_);
  const auto place = std::upper_bound(sums_.begin(), sums_.end() - 1, rest * sums_.back());
  const auto chosen = static_cast<std::size_t>(place - sums_.begin());
  const Emitter& emitter = emitters_[chosen];
  std::optional<LightSample> result = emitter.light == kNone
                                          ? of_triangle(emitter, p, u)
                                          : of_punctual(scene_.lights[emitter.light].light, p);
  if (result) {
    result->light /= share(chosen);
    result->density *= share(chosen);
  }
  return result;
}

float Lighting::environment_density(const Vec3& wi) const {
  return environment_share_ > 0 ? environment_share_ * environment_->pdf(wi) : 0;
}

float Lighting::emitter_density(PrimitiveId id, float distance, float cosine) const {
  const auto end = emitters_.begin() + static_cast<std::ptrdiff_t>(triangles_);
  const auto place = std::ranges::lower_bound(emitters_.begin(), end, id, {}, &Emitter::id);
  if (place == end || place->id != id || !(cosine > 0)) return 0;
  return share(static_cast<std::size_t>(place - emitters_.begin())) * distance * distance /
         (place->area * cosine);
}

}  // namespace microtrace
