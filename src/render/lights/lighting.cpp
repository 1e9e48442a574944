#include "render/lights/lighting.hpp"

#include "render/lights/punctual.hpp"
#include "render/luminance.hpp"
#include "render/sampling/warps.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace microtrace {
namespace {

Vec3 corner_weights(const Vec2& u) {
  const Vec2 w = sampling::triangle_weights(u);
  return {w.x, w.y, std::max(1 - w.x - w.y, 0.0F)};
}

double area_of(const Triangle& t) {
  const DVec3 n = glm::cross(DVec3(t.b) - DVec3(t.a), DVec3(t.c) - DVec3(t.a));
  return std::sqrt(glm::dot(n, n)) / 2;
}

}  // namespace

Lighting::Lighting(const Scene& scene, const Shading& shading) : scene_(scene), shading_(shading) {
  if (scene.environment) {
    environment_.emplace(*scene.environment);
  } else if (scene.lights.empty()) {
    environment_.emplace(Environment{.content = Studio{}});
  }
  std::vector<LightBounds> bounds;
  add_triangles(shading, bounds);
  add_lights(bounds);
  if (!bounds.empty()) tree_.emplace(bounds);
  if (environment_) environment_light_ = environment_->sampled_luminance() / bsdf::kInversePi;
  for (const std::uint32_t i : far_lights_) {
    if (const auto light = of_punctual(scene.lights[i].light, Vec3(0)))
      far_light_ += luminance(light->light);
  }
}

// About in proportion to what each brings, but none too seldom. A uniform environment gets its
// share of samples too, which are none.
Lighting::Shares Lighting::shares(const Receiver& receiver) const {
  constexpr float least = 0.1F;
  const float tree = tree_ ? tree_->importance(receiver.p, receiver.n) : 0;
  const float sum = environment_light_ + far_light_ + tree;
  const auto part = [&](bool is_there, float light) {
    return is_there ? std::max(sum > 0 ? light / sum : 0, least) : 0;
  };
  const Shares raw{.environment = part(environment_light_ > 0, environment_light_),
                   .far = part(!far_lights_.empty(), far_light_),
                   .tree = part(tree_.has_value(), tree)};
  const float all = raw.environment + raw.far + raw.tree;
  return {.environment = raw.environment / all, .far = raw.far / all, .tree = raw.tree / all};
}

void Lighting::add_triangles(const Shading& shading, std::vector<LightBounds>& bounds) {
  PrimitiveId id = 0;
  for (const Object& object : scene_.objects) {
    const std::size_t count = primitive_count(object.shape);
    const Material& material = material_of(scene_, object);
    const auto* mesh = std::get_if<Mesh>(&object.shape);
    const bool shines = mesh != nullptr && material.emissive != Vec3(0) && !material.unlit;
    for (std::size_t i = 0; shines && i < count; ++i) {
      const auto number = static_cast<PrimitiveId>(id + i);
      const Triangle t = triangle_of(*mesh, i);
      const auto area = static_cast<float>(area_of(t));
      // Filtered over about the triangle.
      const ShadingPoint middle =
          shading.point_on(number, Vec3(1 / 3.0F), true, std::sqrt(area) * 0.75F);
      const float power = area * luminance(shading.emission(middle));
      if (!(power > 0)) continue;
      emitters_.push_back({.id = number, .light = kNone, .area = area});
      bounds.push_back({.low = glm::min(t.a, glm::min(t.b, t.c)),
                        .high = glm::max(t.a, glm::max(t.b, t.c)),
                        .power = power,
                        .cone = {.axis = middle.at.n},
                        .two_sided = material.double_sided});
    }
    id += static_cast<PrimitiveId>(count);
  }
  triangles_ = emitters_.size();
}

void Lighting::add_lights(std::vector<LightBounds>& bounds) {
  for (std::uint32_t i = 0; i < scene_.lights.size(); ++i) {
    if (const auto light = punctual_bounds(scene_.lights[i].light)) {
      if (!(light->power > 0)) continue;
      emitters_.push_back({.id = 0, .light = i, .area = 0});
      bounds.push_back(*light);
    } else {
      far_lights_.push_back(i);
    }
  }
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

std::optional<LightSample> Lighting::of_far(const Receiver& receiver, float choice) const {
  const auto count = static_cast<float>(far_lights_.size());
  const auto i = static_cast<std::size_t>(std::min(choice * count, count - 1));
  std::optional<LightSample> result = of_punctual(scene_.lights[far_lights_[i]].light, receiver.p);
  if (result) result->take_share(1 / count);
  return result;
}

std::optional<LightSample> Lighting::of_tree(const Receiver& receiver, const Vec2& u,
                                             float choice) const {
  const std::optional<LightTree::Choice> chosen = tree_->choose(receiver.p, receiver.n, choice);
  if (!chosen) return std::nullopt;
  const Emitter& emitter = emitters_[chosen->light];
  std::optional<LightSample> result =
      emitter.light == kNone ? of_triangle(emitter, receiver.p, u)
                             : of_punctual(scene_.lights[emitter.light].light, receiver.p);
  if (result) result->take_share(chosen->share);
  return result;
}

std::optional<LightSample> Lighting::sample(const Receiver& receiver, const Vec2& u,
                                            float choice) const {
  const Shares share = shares(receiver);
  std::optional<LightSample> result;
  if (choice < share.environment) {
    if (!samples_environment()) return std::nullopt;
    const EnvironmentLight::Sample s = environment_->sample(u);
    result = {
        .way = s.wi, .is_far = true, .wi = s.wi, .light = s.radiance / s.pdf, .density = s.pdf};
    result->take_share(share.environment);
    return result;
  }
  choice -= share.environment;
  if (share.tree == 0 || choice < share.far) {
    if (share.far == 0) return std::nullopt;
    result = of_far(receiver, choice / share.far);
    if (result) result->take_share(share.far);
  } else {
    result = of_tree(receiver, u, sampling::reused(choice, share.far, share.tree));
    if (result) result->take_share(share.tree);
  }
  return result;
}

EnvironmentLight::Look Lighting::environment(const Receiver& receiver, const Vec3& wi) const {
  if (!samples_environment()) return {.radiance = environment(wi), .pdf = 0};
  EnvironmentLight::Look look = environment_->look(wi);
  look.pdf *= shares(receiver).environment;
  return look;
}

float Lighting::emitter_density(PrimitiveId id, const Receiver& receiver, float distance,
                                float cosine) const {
  const auto end = emitters_.begin() + static_cast<std::ptrdiff_t>(triangles_);
  const auto place = std::ranges::lower_bound(emitters_.begin(), end, id, {}, &Emitter::id);
  if (place == end || place->id != id || !(cosine > 0)) return 0;
  const auto light = static_cast<std::size_t>(place - emitters_.begin());
  return shares(receiver).tree * tree_->share(light, receiver.p, receiver.n) * distance * distance /
         (place->area * cosine);
}

}  // namespace microtrace
