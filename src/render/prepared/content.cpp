#include "render/prepared/content.hpp"

#include "base/system/float_environment.hpp"
#include "scene/mesh/mesh_memory.hpp"

#include <utility>

namespace microtrace {

PreparedScene::Content::Content(std::shared_ptr<const Scene> scene, BvhOptions options,
                                std::shared_ptr<SharedTables> tables, MemoryAccount account)
    : scene_(std::move(scene)),
      previous_(std::exchange(options.previous, nullptr)),
      options_(std::move(options)),
      tables_(std::move(tables)),
      memory_(std::move(account)) {}

template <class T, class... Arguments>
std::unique_ptr<T> PreparedScene::Content::make(Arguments&&... arguments) const {
  const std::scoped_lock lock(memory_mutex_);
  const MemoryScope scope(memory_);
  const FloatEnvironment environment;
  return std::make_unique<T>(std::forward<Arguments>(arguments)...);
}

const Bvh& PreparedScene::Content::bvh() const {
  return bvh_.get([&] {
    BvhOptions options = options_;
    options.previous = std::move(previous_);
    return make<Bvh>(*scene_, std::move(options));
  });
}

const SurfaceFinder& PreparedScene::Content::surface_finder() const {
  const Primitives& primitives = bvh().primitives();
  return surface_finder_.get([&] { return make<SurfaceFinder>(primitives); });
}

const Surfaces& PreparedScene::Content::surfaces() const {
  const SurfaceFinder& finder = surface_finder();
  return surfaces_.get(
      [&] { return make<Surfaces>(*scene_, bvh().primitives(), finder, tables_->textures()); });
}

const OneSidedTriangles& PreparedScene::Content::one_sided_triangles() const {
  const Primitives& primitives = bvh().primitives();
  return one_sided_triangles_.get([&] { return make<OneSidedTriangles>(*scene_, primitives); });
}

const Shading& PreparedScene::Content::shading() const {
  const Primitives& primitives = bvh().primitives();
  return shading_.get([&] { return make<Shading>(*scene_, primitives, tables_->textures()); });
}

const Emitters& PreparedScene::Content::emitters() const {
  const Shading& own = shading();
  return emitters_.get([&] { return make<Emitters>(*scene_, own); });
}

Lighting PreparedScene::Content::lighting(const std::optional<Environment>& in_place) const {
  const auto light = [&](const Environment& e) { return EnvironmentLight(e, tables_->of(e)); };
  const std::optional<Environment>& environment = in_place ? in_place : scene_->environment;
  if (environment)
    return {emitters(), light(*environment), environment->is_background, sky_visibility()};
  if (!scene_->lights.empty()) return {emitters(), std::nullopt, false, nullptr};
  return {emitters(), light(Environment{.content = Studio{}}), false, sky_visibility()};
}

const SkyVisibility* PreparedScene::Content::sky_visibility() const {
  const Shading& own = shading();
  const SkyVisibility& visibility =
      sky_visibility_.get([&] { return make<SkyVisibility>(*scene_, bvh(), own); });
  return visibility.is_enclosed() ? &visibility : nullptr;
}

std::optional<PreparedScene::Content::Recentered> PreparedScene::Content::recentered(
    const Camera& camera) const {
  using Bounds = std::optional<PointBounds>;
  const Bounds& points =
      bounds_.get([&] { return std::make_unique<Bounds>(bounds_of_points(*scene_)); });
  if (!points) return std::nullopt;
  const DVec3 by = translation_to_origin(*points, camera);
  if (by == DVec3(0)) return std::nullopt;
  const std::scoped_lock lock(moved_mutex_);
  if (by != moved_by_) {
    moved_.reset();
    moved_by_ = DVec3(0);  // in case that something below throws
    MemoryAccount account(memory_.budget());
    account.take(memory_of(*scene_, PlacedMeshes::copied), "the scene translated to the origin");
    if (std::optional<Scene> scene = moved(*scene_, by))
      moved_ = std::make_shared<const Content>(std::make_shared<const Scene>(*std::move(scene)),
                                               options_, tables_, std::move(account));
    moved_by_ = by;
  }
  if (!moved_) return std::nullopt;
  return Recentered{.content = moved_, .camera = moved(camera, by)};
}

std::shared_ptr<const PreparedScene::Content> PreparedScene::Content::widened(
    const Camera& camera, ImageSize size) const {
  MemoryAccount account(memory_.budget());
  account.take(memory_to_widen(*scene_), "points and lines as triangles");
  const auto scene = std::make_shared<Scene>(*scene_);
  widen_segments(*scene, camera, size);
  BvhOptions options = options_;
  options.previous = tables_->tree();  // of another camera, for which other vertices were added
  auto result =
      std::make_shared<const Content>(scene, std::move(options), tables_, std::move(account));
  tables_->set_tree(result->bvh().tree());
  return result;
}

}  // namespace microtrace
