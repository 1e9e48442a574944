#include "render/aovs/feature_tracer.hpp"

#include "render/lighting/lighting.hpp"
#include "render/media/beer_lambert.hpp"
#include "scene/math/luminance.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace microtrace {
namespace {

constexpr std::size_t kMostSegments = 12;  ///< of a path
constexpr std::size_t kMostPassed = 16;    ///< partly transparent surfaces that a segment meets

/// The maximum roughness of a surface in which other surfaces are seen clearly.
constexpr float kSmooth = 0.25F;

/// Reflections that are weaker than this share are not followed.
constexpr float kFaint = 0.05F;

/// Reduces bright colors to [0, 1] and keeps their hue.
Vec3 bounded(const Vec3& color) {
  return color / std::max({1.0F, color.x, color.y, color.z});
}

/// The paths by which light reaches a smooth surface, and the fraction of light on each.
struct Ways {
  float reflected = 0, transmitted = 0;
  float rest = 1;   ///< scattered by the surface
  Vec3 through{0};  ///< direction of the transmitted ray

  /// Puts a layer that reflects this share of light on the surface.
  void cover(float share) {
    reflected += share * (1 - reflected);
    transmitted *= 1 - share;
    rest *= 1 - share;
  }
  /// Moves the share of a faint reflection to the other ways. Strong reflections keep their shares;
  /// the transition is continuous.
  void drop_faint_reflection() {
    const float others = transmitted + rest;
    if (others <= 0) return;
    reflected = std::max((reflected - kFaint) / (1 - kFaint), 0.0F);
    const float scale = (1 - reflected) / others;
    transmitted *= scale;
    rest *= scale;
  }
  /// Moves the share of the weaker of two rays to the stronger one.
  void keep_stronger_ray() {
    const float both = reflected + transmitted;
    const bool is_mirror = reflected > transmitted;
    reflected = is_mirror ? both : 0;
    transmitted = is_mirror ? 0 : both;
  }
  [[nodiscard]] bool has_two_rays() const { return reflected > 0 && transmitted > 0; }
};

/// The ways to a smooth surface with the normal n. `cosine` is that of the angle between n and wo.
Ways smooth_ways(const bsdf::Parameters& p, const Vec3& n, const Vec3& wo, float cosine) {
  const float eta = p.eta.value_or(1), square = 1 - (1 - cosine * cosine) / (eta * eta);
  const bool is_total = square <= 0;
  // Schlick's term uses the angle in the medium with the lower index of refraction.
  const float least_cosine = eta < 1 && !is_total ? std::sqrt(square) : cosine;
  const float dielectric = is_total ? 1 : luminance(p.dielectric(least_cosine));
  const float entering = (1 - p.metallic) * (1 - dielectric);
  Ways ways{.reflected = 1 - entering,
            .transmitted = entering * p.transmission,
            .rest = entering * (1 - p.transmission)};
  if (ways.transmitted > 0)
    ways.through = p.eta ? (cosine / eta - std::sqrt(square)) * n - wo / eta : -wo;
  return ways;
}

}  // namespace

void FeatureTracer::trace(std::span<const Ray> rays, std::span<DenoiseFeatures> features) {
  features_ = features;
  std::ranges::fill(features, DenoiseFeatures{});
  count_ = rays.size();
  const float sample_width = 1 / std::sqrt(static_cast<float>(world_.samples));
  for (std::size_t i = 0; i < count_; ++i) {
    const Vec3& d = rays[i].d;
    RayGenerator::RowSpacing spacing;
    world_.camera.row_spacings({&d.x, &d.y, &d.z}, {&spacing, 1});
    rays_[i] = rays[i];
    paths_[i] = {.slot = i, .footprint = camera_footprint(spacing, sample_width)};
  }
  std::array<std::optional<Hit>, kMostPaths> hits;
  for (depth_ = 1; count_ > 0; ++depth_) {
    world_.bvh.intersect(std::span(rays_).first(count_), std::span(hits).first(count_),
                         std::span(left_).first(depth_ == 1 ? 0 : count_));
    for (std::size_t i = 0; i < count_; ++i) {
      if (hits[i])
        step(i, *hits[i]);
      else
        escape(rays_[i], paths_[i]);
    }
    advance();
  }
  for (DenoiseFeatures& feature : features) feature.albedo = glm::min(feature.albedo, Vec3(1));
}

void FeatureTracer::escape(const Ray& ray, const Path& path) {
  if (depth_ == 1) return;
  const Vec3 light = world_.lighting->environment(unit<1>(ray.d));
  DenoiseFeatures& feature = features_[path.slot];
  feature.albedo += path.share * bounded(path.tint * light);
  feature.normal += path.share * path.n;
}

void FeatureTracer::step(std::size_t i, Hit hit) {
  const Ray& ray = rays_[i];
  const Vec3 d = unit<1>(ray.d);
  Path path = paths_[i];
  for (std::size_t passed = 0; passed < kMostPassed; ++passed) {
    ShadingPoint point = world_.shading->point(ray, hit);
    point.width = path.footprint.at(point.at.distance);
    Shading::find_texel_address(point);
    const Medium* own = Shading::enclosed_medium(point);
    if (NestedMediaTable::is_hidden(own, point.at.front, path.media)) {
      path.media = media_.without(path.media, *own);
    } else if (const float coverage = world_.shading->coverage(point, depth_ == 1); coverage > 0) {
      const Beyond beyond = media_.cross(own, point.at.front, path.media);
      const BsdfInput& input = world_.shading->bsdf_input(point, 3, beyond.outside, varying_);
      const Vertex vertex{.ray = ray,
                          .hit = hit,
                          .point = point,
                          .parameters = input.parameters,
                          .layers = input.layers,
                          .n = Shading::normal(point, d),
                          .beyond = beyond.media};
      Path here = path;
      here.share *= coverage;
      if (path.media != nullptr) cross_medium(point.at.distance, here);
      if (coverage == 1) return scatter(vertex, here);
      end(vertex, here);
      path.share *= 1 - coverage;
    }
    const std::optional<Hit> next = world_.bvh.next(ray, hit);
    if (!next) return escape(ray, path);
    hit = *next;
  }
}

void FeatureTracer::cross_medium(float distance, Path& path) {
  const Medium& medium = *path.media->medium;
  const Vec3 left = beer_lambert(medium.extinction, distance);
  if (!medium.scatters()) {
    path.tint *= left;
    return;
  }
  // Scattered light has the color of the medium and shows the shape of the last surface.
  DenoiseFeatures& feature = features_[path.slot];
  const float through = std::max({left.x, left.y, left.z});
  feature.albedo += path.share * bounded(path.tint * (Vec3(1) - left) * medium.color);
  feature.normal += path.share * (1 - through) * path.n;
  path.share *= through;
  if (through > 0) path.tint *= left / through;
}

void FeatureTracer::end(const Vertex& vertex, const Path& path) {
  const bsdf::Parameters& p = vertex.parameters;
  Vec3 albedo = p.base_color;
  albedo += p.diffuse_transmission * (p.diffuse_transmission_color - albedo);
  albedo += (1 - p.metallic) * p.dielectric.f0 * (Vec3(1) - albedo);
  albedo += vertex.layers.sheen * (Vec3(1) - albedo);
  if (vertex.point.look->material->unlit) albedo = Vec3(0);
  if (depth_ > 1) albedo += world_.shading->emission(vertex.point);
  DenoiseFeatures& feature = features_[path.slot];
  feature.albedo += path.share * bounded(path.tint * albedo);
  feature.normal += path.share * vertex.n;
}

void FeatureTracer::scatter(const Vertex& vertex, const Path& path) {
  const bsdf::Parameters& p = vertex.parameters;
  const bsdf::Layers& layers = vertex.layers;
  const Vec3 wo = -unit<1>(vertex.ray.d);
  const float cosine = std::min(glm::dot(vertex.n, wo), 1.0F);
  const bool is_smooth = p.roughness <= kSmooth && !vertex.point.look->material->unlit;
  const bool has_coat =
      layers.coat > 0 && layers.coat_roughness <= kSmooth && layers.side != bsdf::LayerSide::below;
  if (depth_ == kMostSegments || !(is_smooth || has_coat) || !(cosine > 0))
    return end(vertex, path);
  Ways ways;
  if (is_smooth) ways = smooth_ways(p, vertex.n, wo, cosine);
  if (has_coat) ways.cover(layers.coat * bsdf::Schlick<1>()(cosine).x);
  ways.drop_faint_reflection();
  if (!path.may_split && ways.has_two_rays()) ways.keep_stronger_ray();
  Path next = path;
  next.may_split = path.may_split && !ways.has_two_rays();
  next.footprint.begin = vertex.point.width;
  next.n = vertex.n;
  if (ways.reflected > 0) {
    next.share = path.share * ways.reflected;
    const float metal = is_smooth ? p.metallic : 0;
    next.tint = path.tint * (Vec3(1) + metal * (p.base_color - Vec3(1)));
    add_ray(vertex, next, (2 * cosine) * vertex.n - wo);
  }
  if (ways.transmitted > 0) {
    next.share = path.share * ways.transmitted;
    next.tint = path.tint * (p.eta ? glm::sqrt(p.base_color) : p.base_color);
    next.media = vertex.beyond;
    add_ray(vertex, next, ways.through);
  }
  next = path;
  next.share = path.share * ways.rest;
  if (next.share > 0) end(vertex, next);
}

void FeatureTracer::add_ray(const Vertex& vertex, const Path& path, const Vec3& direction) {
  spawns_[next_count_] = {.ray = &vertex.ray, .hit = vertex.hit, .direction = direction};
  next_paths_[next_count_++] = path;
}

void FeatureTracer::advance() {
  std::array<std::optional<Vec3>, kMostPaths> origins;
  world_.bvh.spawn_origins(std::span(spawns_).first(next_count_),
                           std::span(origins).first(next_count_));
  count_ = 0;
  for (std::size_t i = 0; i < next_count_; ++i) {
    if (!origins[i]) continue;
    rays_[count_] = {.o = *origins[i], .t_min = 0, .d = spawns_[i].direction};
    left_[count_] = spawns_[i].hit.id;
    paths_[count_++] = next_paths_[i];
  }
  next_count_ = 0;
}

}  // namespace microtrace
