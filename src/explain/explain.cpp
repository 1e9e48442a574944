#include "base/system/float_environment.hpp"
#include "exact/first_hit.hpp"
#include "explain/numbers.hpp"
#include "explain/primitive.hpp"
#include "render/film/camera_rays.hpp"
#include "render/prepared/view.hpp"
#include "render/shading/compositing.hpp"

#include <microtrace/error.hpp>
#include <microtrace/explain.hpp>
#include <microtrace/queries.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <new>
#include <span>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

namespace microtrace {
namespace {

/// Returns all hits of one ray.
std::vector<Hit> all_hits(const Bvh& bvh, const Ray& ray) {
  return intersect_all(bvh, std::span(&ray, 1), {.threads = 1}).hits;
}

/// Returns why a hit counts or not. `is_behind_opaque` is true if the surfaces before it are
/// opaque, `is_new` if no earlier hit is the same point of the same surface.
Verdict verdict_of(const BaseColor& base, AlphaMode mode, bool is_behind_opaque, bool is_new) {
  if (base.is_culled) return Verdict::culled;
  if (!(base.color.w > 0)) return mode == AlphaMode::mask ? Verdict::masked : Verdict::transparent;
  if (is_behind_opaque) return Verdict::hidden;
  return is_new ? Verdict::seen_through : Verdict::repeated;
}

class Explainer {
 public:
  /// The arguments must outlive this object. The ray is in scene coordinates.
  Explainer(const World& world, const Ray& ray, const ExplainOptions& options)
      : world_(world), ray_(ray), options_(options), is_met_(primitives().count()) {}

  [[nodiscard]] Explanation explanation() {
    Explanation result{.ray = ray_,
                       .scene_origin = world_.scene.origin,
                       .is_valid = exact::is_valid(ray_),
                       .primitives = primitives().count()};
    const StageCounts before = stage_counts();
    (void)world_.bvh.intersect(ray_);
    result.stages = stage_counts() - before;
    if (result.is_valid) {
      add_hits(result);
      add_crossings(result);
    }
    if (primitives().count() <= options_.max_misses) add_misses(result);
    return result;
  }

 private:
  [[nodiscard]] const Primitives& primitives() const { return world_.bvh.primitives(); }
  [[nodiscard]] TracedRay traced() const { return {.bvh = world_.bvh, .ray = ray_}; }

  void throw_if_canceled() const {
    if (options_.cancel && options_.cancel())
      throw Error(ErrorKind::canceled, "", "the explanation was canceled");
  }

  void add_hits(Explanation& result) {
    const std::vector<Hit> hits = all_hits(world_.bvh, ray_);
    result.hit_count = hits.size();
    Compositing surfaces(world_, ray_);
    for (std::size_t i = 0; i < hits.size(); ++i) {
      throw_if_canceled();
      is_met_[hits[i].id] = true;
      // The visible hit is found even if it is beyond the limit.
      const bool is_first = !result.visible && world_.surfaces.is_visible(world_, ray_, hits[i]);
      if (is_first) result.visible = i;
      if (i >= options_.max_hits) continue;
      const double before = surfaces.through();
      const bool is_behind_opaque = surfaces.is_opaque();
      const bool is_new = !is_behind_opaque && surfaces.add(hits[i]);
      ExplainedHit hit = explain(hits[i]);
      const BaseColor base = world_.surfaces.base_color(world_, ray_, hits[i]);
      hit.alpha = base.alpha;
      hit.coverage = base.color.w;
      hit.weight = before - surfaces.through();
      hit.verdict =
          is_first ? Verdict::visible : verdict_of(base, hit.alpha_mode, is_behind_opaque, is_new);
      if (i > 0) hit.order = order_of(traced(), hits[i - 1].id, hits[i].id);
      result.hits.push_back(std::move(hit));
    }
  }

  /// Explains a hit, except its order and its visibility.
  [[nodiscard]] ExplainedHit explain(const Hit& hit) const {
    const PrimitiveStages stages = stages_of(traced(), hit.id);
    const SurfaceInteraction at = interact(primitives(), ray_, hit);
    const Object& object = world_.scene.objects.first_of(at.object);
    const Material& material = material_of(world_.scene, object);
    const DVec3 way = at.p - DVec3(ray_.o);
    return {.primitive = explain_primitive(traced(), hit.id, stages.hit),
            .t = hit.t,
            .exact_t = exact_t(traced(), hit.id),
            .rounded_by = stages.t,
            .position = at.p + world_.scene.origin,
            .distance = std::sqrt(glm::dot(way, way)),
            .n = at.n,
            .ns = at.ns,
            .front = at.front,
            .uv = at.uv(0),
            .barycentrics = at.triangle ? std::optional(at.triangle->barycentrics) : std::nullopt,
            .material = object.material,
            .material_name = material.name,
            .alpha_mode = material.alpha_mode,
            .alpha_cutoff = material.alpha_cutoff};
  }

  /// Adds the crossings of the line with a ray that covers a part of the line outside of the
  /// interval. `end` is the interval's end that belongs to that ray, whose hits there are not
  /// crossings, or 0 if it is the origin.
  void add_crossings(Explanation& result, const Ray& part, float end, bool is_before) {
    const TracedRay along{.bvh = world_.bvh, .ray = part};
    const bool is_reversed = part.d != ray_.d;
    std::vector<Hit> hits = all_hits(world_.bvh, part);
    std::erase_if(hits, [&](const Hit& hit) { return is_at(along, hit.id, end); });
    result.crossing_count += hits.size();
    for (const Hit& hit : hits) is_met_[hit.id] = true;
    hits.resize(std::min(hits.size(), options_.max_hits));
    if (is_reversed) std::ranges::reverse(hits);
    for (const Hit& hit : hits) {
      throw_if_canceled();
      const double t = exact_t(along, hit.id);
      result.crossings.push_back(
          {.primitive = explain_primitive(traced(), hit.id, stages_of(traced(), hit.id).hit),
           .t = is_reversed ? -t : t,
           .is_before = is_before,
           .position = interact(primitives(), part, hit).p + world_.scene.origin});
    }
  }

  void add_crossings(Explanation& result) {
    // Behind the origin. A reversed ray that begins at the least positive t meets everything but
    // the surface that the origin is on.
    const Ray behind{.o = ray_.o, .d = -ray_.d};
    add_crossings(result, behind, behind.t_min, true);
    if (ray_.t_min > 0) {
      const Ray near{.o = ray_.o, .t_min = 0, .d = ray_.d, .t_max = ray_.t_min};
      add_crossings(result, near, ray_.t_min, true);
    }
    if (std::isfinite(ray_.t_max)) {
      const Ray far{.o = ray_.o, .t_min = ray_.t_max, .d = ray_.d};
      add_crossings(result, far, ray_.t_max, false);
    }
  }

  void add_misses(Explanation& result) {
    result.misses.emplace();
    for (PrimitiveId id = 0; id < primitives().count(); ++id) {
      if (is_met_[id]) continue;
      throw_if_canceled();
      ExplainedPrimitive primitive = explain_primitive(traced(), id, stages_of(traced(), id).hit);
      std::string reason = miss_reason(primitive.numbers);
      result.misses->push_back({.primitive = std::move(primitive), .reason = std::move(reason)});
    }
  }

  const World& world_;
  const Ray& ray_;
  const ExplainOptions& options_;
  std::vector<bool> is_met_;  // by primitive: whether the ray's line meets it
};

/// Returns the explanation of a ray in scene coordinates, which belongs to this view.
Explanation explain_in(const SceneView& view, const Ray& ray, const ExplainOptions& options) {
  const World world = view.world(1);
  try {
    return Explainer(world, ray, options).explanation();
  } catch (const std::bad_alloc&) {
    throw Error(ErrorKind::limit, "", "no memory for the explanation; limit its hits");
  }
}

/// The content of a prepared scene, which must outlive the result.
std::shared_ptr<const PreparedScene::Content> content_of(const PreparedScene& scene) {
  return {std::shared_ptr<void>(), &scene.content()};
}

}  // namespace

Explanation explain(const PreparedScene& scene, const Ray& ray, const ExplainOptions& options) {
  return explain_in_scene(scene, scene.in_scene(ray), options);
}

Explanation explain_in_scene(const PreparedScene& scene, const Ray& ray,
                             const ExplainOptions& options) {
  const FloatEnvironment environment;
  // The differentials of this camera are so small that textures are looked up at points.
  const OrthographicCamera points{.height = std::numeric_limits<double>::min()};
  return explain_in({content_of(scene), points, {.width = 1, .height = 1}}, ray, options);
}

Explanation explain(const PreparedScene& scene, const Camera& camera, ImageSize size, double x,
                    double y, const ExplainOptions& options) {
  const FloatEnvironment environment;
  if (size.width == 0 || size.height == 0 ||
      !(x >= 0 && x <= size.width && y >= 0 && y <= size.height))
    throw Error(ErrorKind::usage, "", "the point is outside of the picture");
  const SceneView view(content_for(content_of(scene), camera, size), camera, size);
  const Ray ray = CameraRays(view.camera, view.content->scene())(x, y);
  Explanation result = explain_in(view, ray, options);
  result.pixel = {.x = x, .y = y, .size = size};
  for (ExplainedHit& hit : result.hits)
    hit.depth = view.camera.depth(hit.position - result.scene_origin);
  return result;
}

}  // namespace microtrace
