#include "accel/bvh_tree.hpp"
#include "base/lazy.hpp"
#include "float_environment.hpp"
#include "queries/kernels/dispatch.hpp"
#include "queries/locator.hpp"
#include "queries/nearest_search.hpp"
#include "queries/open_edges.hpp"
#include "queries/runs.hpp"

#include <microtrace/error.hpp>
#include <microtrace/queries.hpp>

#include <cassert>
#include <limits>
#include <string>
#include <utility>

namespace microtrace {
namespace {

/// The number of points that a thread takes at a time.
constexpr std::uint64_t kPointsOfRun = 64;

Selection selection_of(const Primitives& primitives, std::optional<std::size_t> object) {
  if (!object) return {.first = 0, .end = primitives.count()};
  const std::size_t count = primitives.scene().objects.size();
  if (*object >= count) {
    throw Error(ErrorKind::usage, "",
                "the object must be one of the scene's " + std::to_string(count) +
                    ", numbered from 0, not " + std::to_string(*object));
  }
  const std::uint64_t first = primitives.first_id_of(*object);
  return {.first = first,
          .end = first + primitive_count(primitives.scene().objects[*object].shape)};
}

}  // namespace

struct Solid::Impl {
  Impl(PreparedScene prepared, std::optional<std::size_t> object)
      : scene(std::move(prepared)), selection(selection_of(primitives, object)) {}

  [[nodiscard]] const DVec3& origin() const { return scene.scene().origin; }
  [[nodiscard]] Vec3 in_scene(const Vec3& p) const {
    return origin() == DVec3(0) ? p : Vec3(DVec3(p) - origin());
  }

  /// Calls f(i, locator, search, poll) for each point.
  template <class F>
  void for_each(std::size_t count, const QueryOptions& options, const F& f) const {
    const FloatEnvironment environment;
    limiting_memory([&] {
      for_each_run(count, kPointsOfRun, options,
                   [&](std::uint64_t first, std::uint64_t last, Poll& poll) {
                     Locator locator(target, selection);
                     NearestSearch search(target, selection);
                     for (std::uint64_t i = first; i < last; ++i) {
                       poll();
                       f(i, locator, search, poll);
                     }
                   });
    });
  }

  PreparedScene scene;
  const Primitives& primitives = scene.bvh().primitives();
  std::shared_ptr<const BvhTree> shared = scene.bvh().tree();
  TreeTarget target{
      .primitives = primitives, .tree = shared->tree, .kernels = kQueryKernels.best()};
  Selection selection;
  Lazy<std::vector<OpenEdge>> edges;
};

Solid::Solid(PreparedScene scene, std::optional<std::size_t> object)
    : impl_(std::make_shared<const Impl>(std::move(scene), object)) {}

std::span<const OpenEdge> Solid::open_edges() const {
  return impl_->edges.get([this] {
    return limiting_memory([this] {
      auto edges = microtrace::open_edges(impl_->primitives, impl_->selection);
      for (OpenEdge& edge : edges) edge.a += impl_->origin(), edge.b += impl_->origin();
      return std::make_unique<std::vector<OpenEdge>>(std::move(edges));
    });
  });
}

void Solid::locate(std::span<const Vec3> points, std::span<Location> locations,
                   const QueryOptions& options) const {
  assert(points.size() == locations.size());
  impl_->for_each(points.size(), options,
                  [&](std::uint64_t i, Locator& locator, NearestSearch&, Poll& poll) {
                    locations[i] = locator.locate(impl_->in_scene(points[i]), poll);
                  });
}

void Solid::nearest_points(std::span<const Vec3> points,
                           std::span<std::optional<NearestPoint>> nearest,
                           const QueryOptions& options) const {
  assert(points.size() == nearest.size());
  impl_->for_each(points.size(), options,
                  [&](std::uint64_t i, Locator&, NearestSearch& search, Poll& poll) {
                    nearest[i] = search.nearest(impl_->in_scene(points[i]), poll);
                    if (nearest[i]) nearest[i]->p += impl_->origin();
                  });
}

void Solid::signed_distances(std::span<const Vec3> points, std::span<double> distances,
                             const QueryOptions& options) const {
  assert(points.size() == distances.size());
  impl_->for_each(points.size(), options,
                  [&](std::uint64_t i, Locator& locator, NearestSearch& search, Poll& poll) {
                    const Vec3 p = impl_->in_scene(points[i]);
                    const auto nearest = search.nearest(p, poll);
                    distances[i] =
                        nearest ? nearest->distance : std::numeric_limits<double>::infinity();
                    if (nearest && distances[i] != 0 && locator.locate(p, poll) == Location::inside)
                      distances[i] = -distances[i];
                  });
}

}  // namespace microtrace
