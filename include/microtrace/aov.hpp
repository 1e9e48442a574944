#pragma once
/// Exact quantities of what is seen through the centre of each pixel, for pictures of their own and
/// for channels beside the colours ("arbitrary output variables"). Never filtered.

#include <microtrace/export.hpp>
#include <microtrace/film.hpp>
#include <microtrace/integrator.hpp>

#include <array>
#include <optional>
#include <string_view>

namespace microtrace {

/// Of the first surface that the ray through the pixel's centre meets: one that is cut out by its
/// material's alpha, or whose back is not seen, is none; one that is seen through in part is.
/// Lengths and vectors are in world space. All numbers are 0 where there is no surface, but depth
/// and distance, which are infinite.
///
/// To add one: a value here and in kAovs, its row and its value in src/render/aov.cpp, a line in
/// docs/outputs.md.
enum class Aov {
  depth,        ///< Z: along the viewing direction from the camera; environment camera: distance
  distance,     ///< T: from the camera's position; of an orthographic camera, from its plane
  position,     ///< X, Y, Z
  normal,       ///< X, Y, Z: the shading normal, on the side that is seen; of unit length
  face_normal,  ///< X, Y, Z: the geometric normal, on the side that is seen; of unit length
  uv,           ///< U, V: texture coordinates of set 0
  barycentric,  ///< X, Y, Z: the weights of a triangle's corners
  albedo,       ///< R, G, B: the base colour with textures and vertex colours, linear Rec. 709
  id,           ///< instance: the place in Scene::objects; primitive: in the object; material: in
                ///< Scene::materials; each counted from 1, material 0 where there is none; uint32
};

inline constexpr std::array kAovs = {Aov::depth,       Aov::distance,    Aov::position,
                                     Aov::normal,      Aov::face_normal, Aov::uv,
                                     Aov::barycentric, Aov::albedo,      Aov::id};

/// As above; on the command line, and before the dot in the names of channels.
[[nodiscard]] MICROTRACE_EXPORT std::string_view name_of(Aov aov);
[[nodiscard]] MICROTRACE_EXPORT std::optional<Aov> aov_named(std::string_view name);

/// A picture of one quantity. id shows instances in colours that tell them apart. Numbers are those
/// above, and 8-bit formats show them so: normals n as (n + 1) / 2; depth and distance from 1 for
/// the nearest to 0.2 for the farthest seen, 0 where there is nothing; positions from 0 to 1 in the
/// bounding box of those seen; albedo encoded as sRGB; the others as they are.
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
