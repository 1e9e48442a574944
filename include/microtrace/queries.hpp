#pragma once
/// Queries of many rays and points: all hits of rays, points inside and outside of closed meshes,
/// nearest points.

#include <microtrace/export.hpp>
#include <microtrace/hit.hpp>
#include <microtrace/math.hpp>
#include <microtrace/prepared_scene.hpp>
#include <microtrace/ray.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace microtrace {

/// Results depend on none of these options.
struct QueryOptions {
  unsigned threads = 0;  ///< 0: default_threads()
  /// See RenderOptions::run_threads.
  std::function<void(unsigned threads, const std::function<void()>& work)> run_threads{};
  /// Called about 50 times per second by each working thread, including the caller's, with the
  /// fraction of the rays or points that are done, in [0, 1]; by one thread at a time. If it
  /// returns false, the query stops at once and throws Error (canceled); its results are then
  /// unspecified.
  std::function<bool(double)> progress{};
};

/// Hits of several rays. Those of ray i are hits[offsets[i]] to below hits[offsets[i + 1]].
struct RayHits {
  std::vector<std::uint64_t> offsets{0};  ///< one more than there are rays
  std::vector<Hit> hits{};

  [[nodiscard]] std::size_t rays() const { return offsets.size() - 1; }
  [[nodiscard]] std::span<const Hit> of(std::size_t ray) const {
    return std::span(hits).subspan(offsets[ray], offsets[ray + 1] - offsets[ray]);
  }
};

/// All hits of each ray in the order (t, PrimitiveId). They equal the results of
/// PreparedScene::intersect and repeated calls of PreparedScene::next, but are found faster. Each
/// primitive counts once. Throws Error: limit if memory runs out; canceled.
[[nodiscard]] MICROTRACE_EXPORT RayHits intersect_all(const PreparedScene& scene,
                                                      std::span<const Ray> rays,
                                                      const QueryOptions& options = {});

/// counts[i] is the number of hits of rays[i] that intersect_all returns: a ray through an edge or
/// a vertex of a mesh hits each triangle there, a ray through a sphere hits it once. Both spans
/// have the same size. Throws Error (canceled).
MICROTRACE_EXPORT void count_crossings(const PreparedScene& scene, std::span<const Ray> rays,
                                       std::span<std::uint32_t> counts,
                                       const QueryOptions& options = {});

/// The position of a point relative to a solid.
enum class Location : std::uint8_t { outside, boundary, inside };

/// The point of a solid's surface that is nearest to a given point.
struct NearestPoint {
  PrimitiveId id = 0;           ///< the nearest triangle; if several are equally near, the one with
                                ///< the lowest number
  double distance = 0;          ///< 0 only if the given point is on the surface
  DVec3 p{0};                   ///< position, world space
  DVec3 barycentrics{1, 0, 0};  ///< weights of the triangle's vertices: none negative, their sum 1
                                ///< up to rounding
};

/// An edge that belongs to an odd number of triangles.
struct OpenEdge {
  PrimitiveId triangle = 0;  ///< the triangle with the lowest number among them
  std::uint32_t side = 0;    ///< of this triangle; 0: from a to b, 1: from b to c, 2: from c to a
  std::uint32_t count = 1;   ///< number of triangles with the edge
  DVec3 a{0}, b{0};          ///< ends, world space
};

/// The triangles of a scene, in meshes or alone, as the surface of a solid. Other shapes are
/// ignored.
///
/// A point is on the boundary if it is in a triangle, which is a closed set. Otherwise it is inside
/// if a ray from it that avoids all edges and vertices crosses an odd number of triangles. This is
/// decided for the real numbers that the float32 numbers of the scene and the point represent. It
/// is therefore never wrong for a closed surface, in which each edge belongs to an even number of
/// triangles. Vertices at equal positions are one vertex here, as glTF duplicates vertices at
/// seams; triangles may be oriented in any way, intersect, or coincide. docs/exactness.md has the
/// definitions.
///
/// Points are in world space. If Scene::origin is not zero, they are translated in float64 and
/// rounded to float32 once, as PreparedScene does with the origins of rays.
///
/// Immutable and cheap to copy; copies share everything. Any number of threads may use it at the
/// same time.
class MICROTRACE_EXPORT Solid {
 public:
  /// All triangles of the scene, or those of one object: an index into Scene::objects. Throws Error
  /// (usage) if there is no such object.
  explicit Solid(PreparedScene scene, std::optional<std::size_t> object = {});

  /// True if there are no open edges; computed on first use. Triangles with coordinates that are
  /// not finite are empty and don't count.
  [[nodiscard]] bool is_closed() const { return open_edges().empty(); }
  /// In the order of their triangles and sides. The memory belongs to this object and its copies.
  /// Throws Error (limit) if memory runs out.
  [[nodiscard]] std::span<const OpenEdge> open_edges() const;

  /// locations[i] is the location of points[i]; both spans have the same size. If the surface is
  /// not closed, a point that is not on the boundary is inside if some ray, chosen by the position
  /// of the point, crosses an odd number of triangles. Points that are not finite are outside.
  /// Throws Error (canceled).
  void locate(std::span<const Vec3> points, std::span<Location> locations,
              const QueryOptions& options = {}) const;

  /// nearest[i] is the point of the surface that is nearest to points[i]; nothing if points[i] is
  /// not finite or there are no triangles. Both spans have the same size. The triangle is the
  /// nearest over the real numbers. The distance has a relative error of at most 2^-38. The
  /// position is a point of the triangle. Its error is at most 2^-40 times the largest magnitude of
  /// the differences between the coordinates of the point and the triangle's vertices, plus the
  /// rounding of its coordinates to float64. Bits are the same on every machine. Throws Error
  /// (canceled).
  void nearest_points(std::span<const Vec3> points, std::span<std::optional<NearestPoint>> nearest,
                      const QueryOptions& options = {}) const;

  /// distances[i] is the distance from points[i] to the surface, negative if the point is inside
  /// and 0 if it is on the boundary; infinity if the point is not finite or there are no triangles.
  /// Both spans have the same size. Throws Error (canceled).
  void signed_distances(std::span<const Vec3> points, std::span<double> distances,
                        const QueryOptions& options = {}) const;

 private:
  struct MICROTRACE_HIDDEN Impl;
  std::shared_ptr<const Impl> impl_;
};

}  // namespace microtrace
