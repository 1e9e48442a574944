#pragma once
/// Explains what a ray meets: all hits in exact order, the numbers that decide each of them, and
/// why a hit is visible or not.

#include <microtrace/camera.hpp>
#include <microtrace/export.hpp>
#include <microtrace/hit.hpp>
#include <microtrace/material.hpp>
#include <microtrace/math.hpp>
#include <microtrace/prepared_scene.hpp>
#include <microtrace/ray.hpp>
#include <microtrace/stage_counts.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace microtrace {

// Numbers of type double in the next structs are exact results rounded once to float64, ties to
// even; they are infinite beyond float64. Signs are those of the exact results. t is measured in
// multiples of the ray's direction d; o is the ray's origin.

/// A sphere or a quadric: a t^2 + b t + c = 0.
struct QuadraticNumbers {
  double a = 0, b = 0, c = 0;
  double discriminant = 0;    ///< b^2 - 4 a c
  int discriminant_sign = 0;  ///< 0 for a tangent ray if a is not 0
  int a_sign = 0, b_sign = 0, c_sign = 0;
  std::vector<double> roots{};  ///< in ascending order; one for a tangent ray and for a linear
                                ///< equation
};

/// A plane with the normal n through p: t = height / slope.
struct PlaneNumbers {
  double slope = 0;   ///< n . d; 0 if the ray is parallel to the plane
  double height = 0;  ///< n . (p - o)
  int slope_sign = 0, height_sign = 0;
  std::optional<double> t{};  ///< where the ray's line crosses the plane, unless it is parallel
};

/// A disc. It is hit where the line crosses its plane, at most a radius from the center, or, by a
/// ray in the plane, where the line enters the ball with the same center and radius.
struct DiscNumbers {
  PlaneNumbers plane{};
  std::optional<double> squared_distance{};  ///< of the crossing from the center
  double squared_radius = 0;
  int side = 0;                            ///< sign of squared_distance - squared_radius
  std::optional<QuadraticNumbers> ball{};  ///< for rays in the disc's plane
};

/// A triangle a, b, c. The line passes inside all edges if no two volumes have opposite signs.
struct TriangleNumbers {
  PlaneNumbers plane{};
  /// Six times the volumes that d spans at o with the edges from b to c, c to a and a to b. Their
  /// sum is the plane's slope.
  std::array<double, 3> volumes{};
  std::array<int, 3> signs{};
  /// The values of t between which the line is in the triangle, if the line lies in the triangle's
  /// plane or the triangle has no area.
  std::optional<std::array<double, 2>> stretch{};
};

/// The numbers of an intersection; std::monostate if the ray is invalid or the shape is empty.
using IntersectionNumbers =
    std::variant<std::monostate, QuadraticNumbers, PlaneNumbers, DiscNumbers, TriangleNumbers>;

/// The stages of an intersection test; see docs/exactness.md.
enum class Stage : std::uint8_t {
  float32,  ///< kernels
  float64,  ///< tests of edges, and filters
  grid,     ///< exact fixed-width integers
  dyadic,   ///< exact numbers of arbitrary width
};

/// A primitive and how the ray's line meets it.
struct ExplainedPrimitive {
  PrimitiveId id = 0;
  std::size_t object = 0;     ///< index into Scene::objects
  std::string name{};         ///< of the object
  PrimitiveId primitive = 0;  ///< index within the object
  std::string_view type{};    ///< of the object's shape: "sphere", "mesh", ...
  IntersectionNumbers numbers{};
  Stage decided_by = Stage::float32;  ///< decided whether the ray hits the primitive
  /// Where the numbers are derived, such as "docs/derivations.md#sphere".
  std::string_view derivation{};
};

/// Why a hit of the ray counts or not.
enum class Verdict : std::uint8_t {
  visible,       ///< the first visible hit, which Aov describes
  seen_through,  ///< behind partly transparent surfaces
  hidden,        ///< behind opaque surfaces
  culled,        ///< on the back of a one-sided surface
  masked,        ///< removed by an alpha mask
  transparent,   ///< blended with alpha 0
  repeated,      ///< the same point of the same mesh as an earlier hit, on a common edge or vertex
};

/// How the order of a hit and its predecessor was decided.
enum class OrderDecision : std::uint8_t {
  first,   ///< there is no predecessor
  bounds,  ///< by float64 bounds of t that don't overlap
  exact,   ///< by exact comparison
  tie,     ///< t is exactly equal, so the lower PrimitiveId comes first
};

struct ExplainedHit {
  ExplainedPrimitive primitive{};
  float t = 0;                        ///< the exact t, rounded once to float32, as in Hit
  double exact_t = 0;                 ///< the exact t, rounded once to float64
  Stage rounded_by = Stage::float32;  ///< computed t, given that the ray hits the primitive
  OrderDecision order = OrderDecision::first;
  DVec3 position{0};                        ///< world space
  double distance = 0;                      ///< from the ray's origin
  std::optional<double> depth{};            ///< see Aov::depth; set for rays of pixels
  DVec3 n{0, 0, 1}, ns{0, 0, 1};            ///< see SurfaceInteraction
  bool front = true;                        ///< true if the ray arrives at the front side
  std::optional<DVec2> uv{};                ///< texture coordinates of set 0
  std::optional<DVec3> barycentrics{};      ///< weights of the triangle's vertices
  std::optional<std::uint32_t> material{};  ///< index into Scene::materials
  std::string material_name{};
  Verdict verdict = Verdict::visible;
  AlphaMode alpha_mode = AlphaMode::opaque;
  float alpha = 1;         ///< of the base color, before the alpha mode applies; 0 if culled
  float alpha_cutoff = 0;  ///< for AlphaMode::mask
  float coverage = 1;      ///< alpha of World::base_color
  double weight = 1;       ///< share of the surface in the color of a flat picture
};

/// A point where the ray's line meets a primitive outside of the ray's interval.
struct ExplainedCrossing {
  ExplainedPrimitive primitive{};
  double t = 0;            ///< the exact t, rounded once to float64
  bool is_before = false;  ///< true before t_min, false beyond t_max
  DVec3 position{0};       ///< world space
};

/// A primitive that the ray's line misses.
struct ExplainedMiss {
  ExplainedPrimitive primitive{};
  std::string reason{};
};

/// The pixel of a ray.
struct ExplainedPixel {
  double x = 0, y = 0;  ///< pixel coordinates as in RayGenerator: (0.5, 0.5) is the center of the
                        ///< first pixel
  ImageSize size{};
  std::string camera{};  ///< the camera's name, if the caller knows it
};

struct Explanation {
  Ray ray{};                   ///< in scene coordinates, from which the exact numbers are computed
  DVec3 scene_origin{0};       ///< see Scene::origin
  bool is_valid = true;        ///< false if the ray hits nothing because it is invalid (see Ray)
  PrimitiveId primitives = 0;  ///< number of primitives in the scene
  std::optional<ExplainedPixel> pixel{};
  StageCounts stages{};                        ///< tests for the nearest hit in the whole scene
  std::vector<ExplainedHit> hits{};            ///< in the order (t, PrimitiveId)
  std::uint64_t hit_count = 0;                 ///< may exceed hits.size(), see ExplainOptions
  std::optional<std::uint64_t> visible{};      ///< number of the first visible hit, counted from 0
  std::vector<ExplainedCrossing> crossings{};  ///< in ascending order of t
  std::uint64_t crossing_count = 0;            ///< may exceed crossings.size()
  /// The primitives that are neither in hits nor in crossings, unless the scene has too many.
  std::optional<std::vector<ExplainedMiss>> misses{};
};

/// Limits of an explanation, because each primitive in it takes about 100 microseconds and 1 KiB.
struct ExplainOptions {
  std::size_t max_hits = 1000;  ///< maximum number of hits, and of crossings before and after them
  std::size_t max_misses = 64;  ///< misses are explained in scenes of at most this many primitives
  /// Called before each primitive is explained. If it returns true, Error (canceled) is thrown.
  std::function<bool()> cancel{};
};

/// Explains a ray in world space. Textures are looked up without a footprint, because the ray
/// belongs to no pixel. Segments of meshes have no area, so they are not hit. Throws Error (limit)
/// if memory runs out.
[[nodiscard]] MICROTRACE_EXPORT Explanation explain(const PreparedScene& scene, const Ray& ray,
                                                    const ExplainOptions& options = {});

/// Like the other function, but for a ray in scene coordinates, see PreparedScene::in_scene.
[[nodiscard]] MICROTRACE_EXPORT Explanation explain_in_scene(const PreparedScene& scene,
                                                             const Ray& ray,
                                                             const ExplainOptions& options = {});

/// Explains the ray of a picture through the pixel coordinates (x, y), with (0, 0) in the upper
/// left corner of the picture and (0.5, 0.5) at the center of the first pixel. At the center of a
/// pixel, the visible hit has the values that render_aovs() stores. The camera is in scene
/// coordinates. Throws Error: usage if the point is outside of the picture, limit if memory runs
/// out.
[[nodiscard]] MICROTRACE_EXPORT Explanation explain(const PreparedScene& scene,
                                                    const Camera& camera, ImageSize size, double x,
                                                    double y, const ExplainOptions& options = {});

/// Returns the explanation as JSON text; docs/explain.md describes the members. Numbers have the
/// digits that identify them; infinite ones are the strings "Infinity" and "-Infinity".
[[nodiscard]] MICROTRACE_EXPORT std::string explanation_json(const Explanation& explanation);

/// Returns where the line passes the triangle, such as "inside", "on edge bc", "on vertex a" or
/// "outside of edge ab".
[[nodiscard]] MICROTRACE_EXPORT std::string place_in_triangle(const TriangleNumbers& numbers);

// The names of values in JSON.
[[nodiscard]] MICROTRACE_EXPORT std::string_view name_of(Stage stage);
[[nodiscard]] MICROTRACE_EXPORT std::string_view name_of(Verdict verdict);
[[nodiscard]] MICROTRACE_EXPORT std::string_view name_of(OrderDecision decision);
[[nodiscard]] MICROTRACE_EXPORT std::string_view name_of(AlphaMode mode);

}  // namespace microtrace
