/// What the paths of a wavefront meet behind surfaces that let paths or light through.

#include "render/integrators/ray_timer.hpp"
#include "render/integrators/wavefront/wave.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace microtrace {

MaskedTriangles Wave::masked() const {
  return {.triangles = shading_->masked(),
          .context = shading_,
          .known =
              [](const void* shading, std::size_t, PrimitiveId id, const HitWeights& at) {
                return static_cast<const Shading*>(shading)->known_visible(id, at);
              },
          .passes =
              [](const void* shading, std::size_t, const Ray& ray, PrimitiveId id) {
                return static_cast<const Shading*>(shading)->is_transparent(ray, id);
              }};
}

void Wave::set_camera_hit(std::size_t i, PrimitiveId id) {
  hits_[i] = id;
  camera_hits_[i].reset();
  if (id != kNoPrimitive) camera_hits_[i] = tracer_.hit(paths_->ray(i), id);
}

void Wave::find_visible() {
  const auto passes = [](const void* self, std::size_t k, const Ray& ray, PrimitiveId id) {
    const auto& wave = *static_cast<const Wave*>(self);
    return wave.is_transparent_to_camera(wave.open_paths_[k], ray, id);
  };
  std::size_t count = 0, widened = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    if (hits_[i] == kNoPrimitive || !shading_->is_masked(hits_[i])) continue;
    if (i >= widened && shading_->has_textures()) {
      widened = i / kShadingLanes * kShadingLanes;
      widen(widened);
      widened += kShadingLanes;
    }
    open_paths_[count] = i;
    const Ray ray = paths_->ray(i);
    if (!passes(this, count, ray, hits_[i])) continue;
    put_vector(open_rays_.o, count, ray.o);
    put_vector(open_rays_.d, count, ray.d);
    open_t_min_[count] = ray.t_min;
    open_rays_.t_max[count] = ray.t_max;
    open_rays_.left[count++] = kNoPrimitive;
  }
  RayColumns rays = columns_of(open_rays_, count);
  rays.t_min = open_t_min_;
  const auto visible = std::span(open_blockers_).first(count);
  const MaskedTriangles masked{.triangles = shading_->masked(), .context = this, .passes = passes};
  tracer_.closest(rays, {.open = tracer_.open_backs(world_->open_backs), .masked = masked},
                  visible);
  for (std::size_t k = 0; k < count; ++k) set_camera_hit(open_paths_[k], visible[k]);
}

void Wave::find_blocked() {
  const PathColumns& paths = *paths_;
  std::size_t count = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    if (hits_[i] == kNoPrimitive || !shading_->has_open_back(hits_[i])) continue;
    put_vector(open_rays_.o, count, vector_of(paths.o, i));
    put_vector(open_rays_.d, count, vector_of(paths.d, i));
    open_rays_.t_max[count] = paths.t_max[i];
    open_rays_.left[count] = paths.left[i];
    open_paths_[count++] = i;
  }
  const RayColumns rays = columns_of(open_rays_, count);
  const auto blockers = std::span(open_blockers_).first(count);
  const HitFilter filter{.open = {.triangles = shading_->triangles_with_open_backs()},
                         .masked = masked()};
  if (lighting_->has_surfaces())
    tracer_.closest(rays, filter, blockers);
  else
    tracer_.any(rays, filter, blockers);
  for (std::size_t k = 0; k < count; ++k) blockers_[open_paths_[k]] = open_blockers_[k];
}

bool Wave::has_passed(std::size_t i, PrimitiveId id) const {
  const std::uint32_t slot = paths_->slot[i];
  return std::any_of(passed_ids_.begin(), passed_ids_.begin() + passed_,
                     [&](const auto& ids) { return ids[slot] == id; });
}

bool Wave::is_transparent_to_camera(std::size_t i, const Ray& ray, PrimitiveId id) const {
  return shading_->is_transparent_to_camera(
      ray, id, {.begin = paths_->begin[i], .spread = paths_->spread[i]});
}

HitFilter Wave::passed() const {
  const auto known = [](const void* self, std::size_t i, PrimitiveId id, const HitWeights& at) {
    const auto& wave = *static_cast<const Wave*>(self);
    if (wave.has_passed(i, id)) return Visible::no;
    return wave.step_.depth == 1 ? Visible::unsure : wave.shading_->known_visible(id, at);
  };
  const auto passes = [](const void* self, std::size_t i, const Ray& ray, PrimitiveId id) {
    const auto& wave = *static_cast<const Wave*>(self);
    return wave.has_passed(i, id) ||
           (wave.step_.depth == 1 ? wave.is_transparent_to_camera(i, ray, id)
                                  : wave.shading_->is_transparent(ray, id));
  };
  return {.open = step_.depth == 1 ? tracer_.open_backs(world_->open_backs) : OpenSide{},
          .masked = {
              .triangles = shading_->masked(), .context = this, .known = known, .passes = passes}};
}

bool Wave::may_continue_later(std::size_t i) const {
  return passed_ < kMostPassed && paths_->media[i] == 0 && shading_->is_masked(hits_[i]);
}

void Wave::continue_later(std::size_t i) {
  passed_ids_[passed_][paths_->slot[i]] = hits_[i];
  passing_[passing_count_++] = static_cast<std::uint32_t>(i);
}

bool Wave::continue_passing() {
  if (passing_count_ == 0) return false;
  count_ = std::exchange(passing_count_, 0);
  ++passed_;
  const auto passing = std::span(passing_).first(count_);
  // Those that need further tests follow the others of their group.
  std::ranges::sort(passing);
  paths_->keep(passing);
  const RayTimer timer(counts_.path, count_);
  const bool from_camera = step_.depth == 1;
  RayColumns rays = columns_of(*paths_, count_);
  if (from_camera) {
    rays.t_min = paths_->t_min;
    std::fill_n(paths_->left, count_, kNoPrimitive);
  }
  tracer_.closest(rays, passed(), std::span(hits_).first(count_));
  if (from_camera) {
    for (std::size_t i = 0; i < count_; ++i) set_camera_hit(i, hits_[i]);
  } else if (knows_blocked()) {
    find_blocked();
  }
  return true;
}

void Wave::set_least_alpha(std::size_t first, const TexturedMaterial& look, float covering_alpha) {
  if (look.material->alpha_mode != AlphaMode::blend) {
    std::ranges::fill(textured_.least_alpha, covering_alpha);
    return;
  }
  kernels_->random_numbers(paths_->key + first, paths_->index + first, coverage_pair(passed_),
                           textured_.least_alpha);
  // stops() is true for alphas greater than the random number, so the next number is the least one.
  for (float& u : textured_.least_alpha)
    u = std::bit_cast<float>(std::bit_cast<std::uint32_t>(u) + 1);
}

}  // namespace microtrace
