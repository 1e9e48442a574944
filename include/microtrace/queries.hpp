#pragma once
/// Bulk queries: all hits of rays, classification of points as inside or outside closed meshes, and
/// nearest points on surfaces.

#include <microtrace/bvh.hpp>
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

/// Options of queries, which never change the results.
struct QueryOptions {
  unsigned threads = 0;  ///< 0: default_threads()
  /// See RenderOptions::run_threads.
  std::function<void(unsigned threads, const std::function<void()>& work)> run_threads{};
  /// Called about 50 times per second by each working thread, possibly the caller's, but by one
  /// thread at a time. The argument is the fraction of the rays or points that are done, in [0, 1].
  /// If the callback returns false, the query stops at once and throws Error (canceled); its
  /// results are then unspecified.
  std::function<bool(double)> progress{};
};

/// The hits of several rays. The hits of ray i have the indices from offsets[i] up to, but not
/// including, offsets[i + 1].
struct RayHits {
  std::vector<std::uint64_t> offsets{0};  ///< the number of rays + 1 elements
  std::vector<Hit> hits{};

  [[nodiscard]] std::size_t rays() const { return offsets.size() - 1; }
  [[nodiscard]] std::span<const Hit> of(std::size_t ray) const {
    return std::span(hits).subspan(offsets[ray], offsets[ray + 1] - offsets[ray]);
  }
};

/// Returns all hits of each ray in the order (t, PrimitiveId). The hits equal those of
/// PreparedScene::intersect and repeated calls of PreparedScene::next, but are found faster. Each
/// primitive counts once. Rays are in world space. Throws Error: limit if memory runs out, canceled
/// if options.progress returns false.
[[nodiscard]] MICROTRACE_EXPORT RayHits intersect_all(const PreparedScene& scene,
                                                      std::span<const Ray> rays,
                                                      const QueryOptions& options = {});

/// Like the other function, but for rays in scene coordinates, as for Bvh::intersect.
[[nodiscard]] MICROTRACE_EXPORT RayHits intersect_all(const Bvh& bvh, std::span<const Ray> rays,
                                                      const QueryOptions& options = {});

/// Sets counts[i] to the number of hits of rays[i] that intersect_all would return. A ray through
/// an edge or a vertex of a mesh hits each triangle there; a ray through a sphere hits it once.
/// Both spans must have the same size. Rays are in world space. Throws Error (canceled) if
/// options.progress returns false.
MICROTRACE_EXPORT void count_crossings(const PreparedScene& scene, std::span<const Ray> rays,
                                       std::span<std::uint32_t> counts,
                                       const QueryOptions& options = {});

/// Like the other function, but for rays in scene coordinates, as for Bvh::intersect.
MICROTRACE_EXPORT void count_crossings(const Bvh& bvh, std::span<const Ray> rays,
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
  std::uint32_t count = 1;   ///< number of triangles that have this edge
  DVec3 a{0}, b{0};          ///< end points, world space
};

/// The triangles of a scene, whether separate or in meshes, as the surface of a solid. Other shapes
/// are ignored.
///
/// A point is on the boundary if it lies in a triangle, on an edge or on a vertex. Otherwise a
/// point is inside if a ray that starts there and avoids all edges and vertices crosses an odd
/// number of triangles. The decision is exact for the real numbers that the float32 numbers of the
/// scene and the point represent. It is therefore never wrong for a closed surface, in which each
/// edge belongs to an even number of triangles. Vertices at equal positions count as one vertex,
/// because glTF duplicates vertices at seams. Triangles may be oriented in any way, intersect, or
/// coincide. docs/exactness.md has the definitions.
///
/// Points are in world space. If Scene::origin is not zero, they are translated in float64 and
/// rounded to float32 once, as PreparedScene does with the origins of rays. Far from the origin of
/// world space, use points in float64, which are not rounded before.
///
/// Immutable and cheap to copy; copies share everything. Any number of threads may use it at the
/// same time.
class MICROTRACE_EXPORT Solid {
 public:
  /// Uses all triangles of the scene, or only those of one object, given by its index in
  /// Scene::objects. Throws Error (usage) if there is no such object.
  explicit Solid(PreparedScene scene, std::optional<std::size_t> object = {});

  /// Returns true if there are no open edges; computed on first use. Triangles with coordinates
  /// that are not finite are empty and don't count. Throws Error (limit) if memory runs out.
  [[nodiscard]] bool is_closed() const { return open_edges().empty(); }
  /// Returns all open edges, ordered by triangle and side; computed on first use. This object and
  /// its copies own the memory. Throws Error (limit) if memory runs out.
  [[nodiscard]] std::span<const OpenEdge> open_edges() const;

  /// Sets locations[i] to the location of points[i]. Both spans must have the same size. If the
  /// surface is not closed, the location of a point off the boundary is decided by a single ray,
  /// whose direction depends on the point's position relative to the scene's bounding box. Points
  /// that are not finite are outside. Throws Error (canceled) if options.progress returns false.
  void locate(std::span<const Vec3> points, std::span<Location> locations,
              const QueryOptions& options = {}) const;
  void locate(std::span<const DVec3> points, std::span<Location> locations,
              const QueryOptions& options = {}) const;

  /// Sets nearest[i] to the point of the surface that is nearest to points[i], or to nothing if
  /// points[i] is not finite or there are no triangles. Both spans must have the same size. Throws
  /// Error (canceled) if options.progress returns false.
  ///
  /// The triangle is the nearest one in real arithmetic. The distance has a relative error of at
  /// most 2^-38. The position lies on the triangle with an error of at most 2^-40 D plus the
  /// rounding of coordinates to float64, where D is the largest coordinate difference between
  /// points[i] and the triangle's vertices. The bits of the results are the same on every machine.
  void nearest_points(std::span<const Vec3> points, std::span<std::optional<NearestPoint>> nearest,
                      const QueryOptions& options = {}) const;
  void nearest_points(std::span<const DVec3> points, std::span<std::optional<NearestPoint>> nearest,
                      const QueryOptions& options = {}) const;

  /// Sets distances[i] to the distance from points[i] to the surface: negative if the point is
  /// inside, 0 if it is on the boundary, and infinite if the point is not finite or there are no
  /// triangles. Both spans must have the same size. Throws Error (canceled) if options.progress
  /// returns false.
  void signed_distances(std::span<const Vec3> points, std::span<double> distances,
                        const QueryOptions& options = {}) const;
  void signed_distances(std::span<const DVec3> points, std::span<double> distances,
                        const QueryOptions& options = {}) const;

 private:
  struct MICROTRACE_HIDDEN Impl;
  std::shared_ptr<const Impl> impl_;
};

}  // namespace microtrace
