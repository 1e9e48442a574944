#include "accel/bvh_tree.hpp"
#include "base/lazy.hpp"
#include "base/system/float_environment.hpp"
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
  return {.first = primitives.first_id_of(*object), .end = primitives.end_id_of(*object)};
}

}  // namespace

struct Solid::Impl {
  Impl(PreparedScene prepared, std::optional<std::size_t> object)
      : scene(std::move(prepared)), selection(selection_of(primitives, object)) {}

  [[nodiscard]] const DVec3& origin() const { return scene.scene().origin; }
  [[nodiscard]] Vec3 in_scene(const Vec3& p) const {
    return origin() == DVec3(0) ? p : Vec3(DVec3(p) - origin());
  }
  [[nodiscard]] Vec3 in_scene(const DVec3& p) const { return Vec3(p - origin()); }

  /// Calls f(i, p, locator, search, poll) for each point p in scene coordinates.
  template <class Point, class F>
  void for_each(std::span<const Point> points, const QueryOptions& options, const F& f) const {
    const FloatEnvironment environment;
    limiting_memory([&] {
      for_each_run(points.size(), kPointsOfRun, options,
                   [&](std::uint64_t first, std::uint64_t last, Poll& poll) {
                     Locator locator(target, selection);
                     NearestSearch search(target, selection);
                     for (std::uint64_t i = first; i < last; ++i) {
                       poll();
                       f(i, in_scene(points[i]), locator, search, poll);
                     }
                   });
    });
  }

  template <class Point>
  void locate(std::span<const Point> points, std::span<Location> locations,
              const QueryOptions& options) const {
    assert(points.size() == locations.size());
    for_each(points, options,
             [&](std::uint64_t i, const Vec3& p, Locator& locator, NearestSearch&, Poll& poll) {
               locations[i] = locator.locate(p, poll);
             });
  }

  template <class Point>
  void nearest_points(std::span<const Point> points, std::span<std::optional<NearestPoint>> nearest,
                      const QueryOptions& options) const {
    assert(points.size() == nearest.size());
    for_each(points, options,
             [&](std::uint64_t i, const Vec3& p, Locator&, NearestSearch& search, Poll& poll) {
               nearest[i] = search.nearest(p, poll);
               if (nearest[i]) nearest[i]->p += origin();
             });
  }

  template <class Point>
  void signed_distances(std::span<const Point> points, std::span<double> distances,
                        const QueryOptions& options) const {
    assert(points.size() == distances.size());
    for_each(
        points, options,
        [&](std::uint64_t i, const Vec3& p, Locator& locator, NearestSearch& search, Poll& poll) {
          const auto nearest = search.nearest(p, poll);
          distances[i] = nearest ? nearest->distance : std::numeric_limits<double>::infinity();
          if (nearest && distances[i] != 0 && locator.locate(p, poll) == Location::inside)
            distances[i] = -distances[i];
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
  const FloatEnvironment environment;
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
  impl_->locate(points, locations, options);
}

void Solid::locate(std::span<const DVec3> points, std::span<Location> locations,
                   const QueryOptions& options) const {
  impl_->locate(points, locations, options);
}

void Solid::nearest_points(std::span<const Vec3> points,
                           std::span<std::optional<NearestPoint>> nearest,
                           const QueryOptions& options) const {
  impl_->nearest_points(points, nearest, options);
}

void Solid::nearest_points(std::span<const DVec3> points,
                           std::span<std::optional<NearestPoint>> nearest,
                           const QueryOptions& options) const {
  impl_->nearest_points(points, nearest, options);
}

void Solid::signed_distances(std::span<const Vec3> points, std::span<double> distances,
                             const QueryOptions& options) const {
  impl_->signed_distances(points, distances, options);
}

void Solid::signed_distances(std::span<const DVec3> points, std::span<double> distances,
                             const QueryOptions& options) const {
  impl_->signed_distances(points, distances, options);
}

}  // namespace microtrace
