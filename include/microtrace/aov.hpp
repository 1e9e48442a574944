#pragma once
/// Exact quantities at the center of each pixel ("arbitrary output variables"), as pictures of
/// their own and as channels beside the colors. Never filtered.

#include <microtrace/export.hpp>
#include <microtrace/film.hpp>
#include <microtrace/integrator.hpp>

#include <array>
#include <optional>
#include <span>
#include <string_view>

namespace microtrace {

/// Describes the first visible surface on the ray through the pixel's center. Culled back faces and
/// surfaces removed by an alpha mask are not visible; partly transparent surfaces are. Lengths and
/// vectors are in world space. Without a surface all values are 0, except depth and distance, which
/// are infinite.
///
/// To add one: a value here and in kAovs, its channels in src/render/aovs/aov.cpp, its value in
/// src/render/aovs/sights.cpp, its colors in 8-bit pictures in src/render/integrators/aov.cpp, its
/// help text in src/cli/options/picture_options.cpp, a line in both tables of docs/outputs.md, a
/// test in tests/unit/aov_test.cpp.
enum class Aov {
  depth,        ///< Z: along the viewing direction from the camera; environment camera: distance
  distance,     ///< T: from the camera's position; for an orthographic camera, from its plane
  position,     ///< X, Y, Z
  normal,       ///< X, Y, Z: the shading normal, facing the viewer; unit length
  face_normal,  ///< X, Y, Z: the geometric normal, facing the viewer; unit length
  uv,           ///< U, V: texture coordinates of set 0
  barycentric,  ///< X, Y, Z: barycentric coordinates of the triangle's vertices
  albedo,       ///< R, G, B: base color with textures and vertex colors, linear Rec. 709
  id,           ///< instance: the place in Scene::objects; primitive: in the object; material: in
                ///< Scene::materials; each counted from 1, material 0 where there is none; uint32
};

inline constexpr std::array kAovs = {Aov::depth,       Aov::distance,    Aov::position,
                                     Aov::normal,      Aov::face_normal, Aov::uv,
                                     Aov::barycentric, Aov::albedo,      Aov::id};

/// The name on the command line, and before the dot in channel names.
[[nodiscard]] MICROTRACE_EXPORT std::string_view name_of(Aov aov);
[[nodiscard]] MICROTRACE_EXPORT std::optional<Aov> aov_named(std::string_view name);
/// The names of its channels, one to three.
[[nodiscard]] MICROTRACE_EXPORT std::span<const std::string_view> channels_of(Aov aov);

/// A picture of one quantity. For id, instances have different colors. 8-bit formats show normals n
/// as (n + 1) / 2; depth and distance from 1 for the nearest to 0.2 for the farthest visible point,
/// 0 where there is none; positions from 0 to 1 in the bounding box of the visible ones; albedo
/// encoded as sRGB; the others unchanged.
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
