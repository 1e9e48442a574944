#include "render/lights/emitters.hpp"

#include "base/memory_account.hpp"
#include "render/lanes/lane_access.hpp"
#include "render/lights/area_light.hpp"
#include "render/lights/punctual.hpp"
#include "render/sampling/warps.hpp"
#include "scene/material_textures.hpp"
#include "scene/math/luminance.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace microtrace {
namespace {

/// The bytes that each emitter needs for its entry, bounds and tree nodes, including unused
/// capacity.
constexpr std::uint64_t kBytesOfEmitter = 368;

void take_memory_for_emitters(std::uint64_t count) {
  take_memory(count * kBytesOfEmitter, "the lights of the scene");
}

}  // namespace

Emitters::Emitters(const Scene& scene, const Shading& shading) : scene_(scene), shading_(shading) {
  std::vector<LightBounds> bounds;
  add_surfaces(bounds);
  add_lights(bounds);
  if (!bounds.empty()) tree_.emplace(bounds);
  for (std::uint32_t light = 0; light < emitters_.size(); ++light) {
    const std::optional<std::uint32_t> triangle = triangle_index(light);
    const bool is_untextured = triangle && triangles_[*triangle].is_textured == 0;
    untextured_triangles_.push_back(is_untextured ? *triangle : kNone);
  }
  for (const std::uint32_t i : far_lights_) {
    if (const auto light = of_punctual(punctual_[i], Vec3(0)))
      far_light_ += luminance(light->light);
  }
}

void Emitters::add_surfaces(std::vector<LightBounds>& bounds) {
  PrimitiveId id = 0;
  for (const ObjectRun& run : scene_.objects.runs()) {
    const auto count = static_cast<PrimitiveId>(primitive_count(run.first->shape));
    const bool emits = is_emissive(material_of(scene_, *run.first));
    for (std::size_t k = 0; k < run.count; ++k, id += count) {
      if (!emits) continue;
      take_memory_for_emitters(count);
      if (const PlacedMesh mesh = run.mesh(k)) {
        for (PrimitiveId i = 0; i < count; ++i) add_triangle(id + i, triangle_of(mesh, i), bounds);
      } else {
        add_shape(id, run.first->shape, bounds);
      }
    }
  }
  surfaces_ = emitters_.size();
}

void Emitters::add_triangle(PrimitiveId id, const Triangle& t, std::vector<LightBounds>& bounds) {
  const double area = triangle_area(t);
  // Uses a texture footprint of about the triangle's size, so that the emission is approximately
  // the mean over the triangle.
  const auto width = static_cast<float>(std::sqrt(area) * 0.75);
  const ShadingPoint middle = shading_.point_on(id, Vec3(1 / 3.0F), true, width);
  const double power = area * luminance(DVec3(shading_.emission(middle)));
  if (!(power > 0)) return;
  emitters_.push_back(
      {.id = id, .triangle = static_cast<std::uint32_t>(triangles_.size()), .area = area});
  const TexturedMaterial& look = *middle.look;
  const Vec3 emission = glm::min(look.material->emissive, Vec3(kBrightest));
  triangles_.push_back(
      {.corners = {{t.a.x, t.a.y, t.a.z}, {t.b.x, t.b.y, t.b.z}, {t.c.x, t.c.y, t.c.z}},
       .emission = {emission.x, emission.y, emission.z},
       .has_back = look.has_back ? 1.0F : 0.0F,
       .id = id,
       .is_textured = look.has_constant_emission ? 0U : 1U});
  bounds.push_back({.low = glm::min(t.a, glm::min(t.b, t.c)),
                    .high = glm::max(t.a, glm::max(t.b, t.c)),
                    .power = power,
                    .cone = {.axis = middle.at.n},
                    .two_sided = has_back(*middle.look->material)});
}

void Emitters::add_shape(PrimitiveId id, const Shape& shape, std::vector<LightBounds>& bounds) {
  std::optional<LightBounds> light = shape_bounds(shape);
  if (!light) return;
  const ShadingPoint point = shading_.point_on(id, Vec3(0), true, 0);
  light->power *= luminance(DVec3(shading_.emission(point)));
  if (!(light->power > 0)) return;
  light->two_sided = has_back(*point.look->material);
  emitters_.push_back({.id = id, .shape = &shape});
  bounds.push_back(*light);
}

void Emitters::add_lights(std::vector<LightBounds>& bounds) {
  take_memory_for_emitters(scene_.lights.size());
  for (std::uint32_t i = 0; i < scene_.lights.size(); ++i) {
    punctual_.push_back(punctual_light(scene_.lights[i].light));
    if (const auto light = punctual_bounds(scene_.lights[i].light)) {
      if (!(light->power > 0)) continue;
      emitters_.push_back({.light = i});
      bounds.push_back(*light);
    } else {
      far_lights_.push_back(i);
    }
  }
}

float LightChoiceSetup::irradiance(double light) const {
  if (!(light > 0)) return 0;
  constexpr double kLeast{LightTreeSpace::kLeast};
  return static_cast<float>(std::clamp(light / space.unit, kLeast, 1 / kLeast));
}

LightChoiceSetup Emitters::choice_setup() const {
  LightChoiceSetup setup{.has_far = has_far()};
  if (tree_) {
    setup.nodes = tree_->nodes();
    setup.space = tree_->space();
  }
  setup.far_light = setup.irradiance(far_light_);
  return setup;
}

void Emitters::put_textured(std::uint32_t triangle, const Vec2& u, int lane,
                            TriangleChoices<kShadingLanes>& choices) const {
  const TriangleLight& light = triangles_[triangle];
  if (light.is_textured == 0) return;
  const ShadingPoint point = shading_.texture_point(light.id, sampling::triangle_point(u));
  put(choices.emission, lane, shading_.emission(point));
  choices.coverage[lane] = shading_.coverage(point, false);
}

std::optional<FoundLight> Emitters::of_shape(const Emitter& emitter, const Vec3& p,
                                             const Vec2& u) const {
  const std::optional<ShapeSample> sample = microtrace::sample_shape(*emitter.shape, p, u);
  if (!sample) return std::nullopt;
  const ShadingPoint point = shading_.point_on(emitter.id, Vec3(0), sample->front, 0);
  const float coverage = shading_.coverage(point, false);
  const Vec3 emission = shading_.emission(point);
  if (coverage == 0 || emission == Vec3(0)) return std::nullopt;
  return FoundLight{.to_light = sample->to_light,
                    .wi = sample->wi,
                    .light = DVec3(emission) * (double{coverage} / sample->pdf),
                    .pdf = sample->pdf,
                    .target = emitter.id};
}

std::uint32_t Emitters::far_light(float choice) const {
  const auto count = static_cast<float>(far_lights_.size());
  return far_lights_[static_cast<std::size_t>(std::min(choice * count, count - 1))];
}

std::optional<LightSample> Emitters::sample_shape(std::uint32_t light, const Vec3& p, const Vec2& u,
                                                  double probability) const {
  const std::optional<FoundLight> found = of_shape(emitters_[light], p, u);
  if (!found) return std::nullopt;
  return found->with_probability(probability);
}

std::optional<std::size_t> Emitters::find(PrimitiveId id) const {
  const auto end = emitters_.begin() + static_cast<std::ptrdiff_t>(surfaces_);
  const auto found = std::ranges::lower_bound(emitters_.begin(), end, id, {}, &Emitter::id);
  if (found == end || found->id != id) return std::nullopt;
  return static_cast<std::size_t>(found - emitters_.begin());
}

float Emitters::pdf(std::size_t light, const LightSampleContext& context, float distance,
                    float cosine, double probability) const {
  const Emitter& emitter = emitters_[light];
  const double length = distance;
  const double pdf = emitter.shape != nullptr
                         ? shape_pdf(*emitter.shape, context.p, distance, cosine)
                         : area_pdf<1>(length * length, emitter.area, cosine);
  probability *= double{tree_->probability(light, context.p, context.n)};
  return probability > 0 ? static_cast<float>(limited_pdf<1>(pdf * probability)) : 0;
}

}  // namespace microtrace
