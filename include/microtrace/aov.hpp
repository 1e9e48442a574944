#pragma once
/// Exact, unfiltered quantities at the center of each pixel ("arbitrary output variables", AOVs).
/// They are rendered as separate pictures or as channels beside the colors.

#include <microtrace/export.hpp>
#include <microtrace/film.hpp>
#include <microtrace/integrator.hpp>

#include <array>
#include <optional>
#include <span>
#include <string_view>

namespace microtrace {

/// A quantity of the first visible surface on the ray through the pixel's center. Culled back faces
/// and surfaces removed by an alpha mask are not visible; partly transparent surfaces are. Lengths
/// and vectors are in world space. Where no surface is visible, depth and distance are infinite,
/// and all other values are 0.
///
/// To add an AOV, add a value here and in kAovs, its channels in src/render/aovs/aov.cpp, its
/// computation in src/render/aovs/sights.cpp, its colors in 8-bit pictures in
/// src/render/integrators/aov.cpp, its help text in src/cli/options/picture_options.cpp, a line in
/// both tables of docs/outputs.md, and a test in tests/unit/render/aov_test.cpp.
enum class Aov {
  depth,        ///< Z: distance from the camera along the viewing direction; for an environment
                ///< camera, equal to distance
  distance,     ///< T: distance along the ray from the camera's position; for an orthographic
                ///< camera, from the plane through its position
  position,     ///< X, Y, Z
  normal,       ///< X, Y, Z: the shading normal of the side that the viewer sees; unit length
  face_normal,  ///< X, Y, Z: the geometric normal, facing the viewer; unit length
  uv,           ///< U, V: texture coordinates of set 0
  barycentric,  ///< X, Y, Z: barycentric weights of the triangle's vertices; 0 for other shapes
  albedo,       ///< R, G, B: base color with textures and vertex colors, linear Rec. 709
  id,           ///< uint32 channels: instance, the index into Scene::objects; primitive, the index
                ///< within the object; material, the index into Scene::materials. Each is counted
                ///< from 1; material is 0 if the object has none
};

inline constexpr std::array kAovs = {Aov::depth,       Aov::distance,    Aov::position,
                                     Aov::normal,      Aov::face_normal, Aov::uv,
                                     Aov::barycentric, Aov::albedo,      Aov::id};

/// The AOV's name on the command line, which is also the part of channel names before the dot.
[[nodiscard]] MICROTRACE_EXPORT std::string_view name_of(Aov aov);
[[nodiscard]] MICROTRACE_EXPORT std::optional<Aov> aov_named(std::string_view name);
/// The names of the AOV's channels, one to three.
[[nodiscard]] MICROTRACE_EXPORT std::span<const std::string_view> channels_of(Aov aov);

/// Renders a picture of one quantity. For id, each instance gets its own color.
///
/// 8-bit formats show normals n as (n + 1) / 2. They scale depth and distance linearly from 1 at
/// the nearest visible point to 0.2 at the farthest, with 0 where nothing is visible. They scale
/// positions so that the bounding box of all visible points spans 0 to 1 on each axis. Albedo is
/// encoded as sRGB; the other quantities are shown unchanged.
class MICROTRACE_EXPORT AovIntegrator final : public Integrator {
 public:
  explicit AovIntegrator(Aov aov) : aov_(aov) {}

  void trace(const World& world, std::span<const Ray> rays, std::span<const SampleId> ids,
             std::span<Sample> samples) const override;
  [[nodiscard]] bool is_data() const override { return true; }
  [[nodiscard]] Display display(const Film& film) const override;

 private:
  Aov aov_;
};

}  // namespace microtrace
