#pragma once
/// Base colors and coverage of a scene's surfaces, without lighting.

#include "render/textures/texture_map.hpp"

#include <microtrace/bvh.hpp>
#include <microtrace/hit.hpp>
#include <microtrace/math.hpp>
#include <microtrace/primitives.hpp>
#include <microtrace/ray.hpp>
#include <microtrace/scene.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

namespace microtrace {

class SharedTextures;
class SurfaceFinder;
struct SurfaceInteraction;
struct World;

/// The cases in which World::first_visible returns the hits of an object.
enum class Visibility : std::uint8_t {
  always,
  in_front,  ///< only if the ray arrives at the front side
  varies,    ///< depending on the point
};

/// The base color at a hit, and how its alpha was found.
struct BaseColor {
  Vec4 color{0};    ///< see World::base_color
  float alpha = 0;  ///< the product of factor, texture and vertex color, to which the alpha mode
                    ///< applies; 0 if the hit is culled
  bool is_culled = false;  ///< true on the back of a one-sided surface
};

/// Immutable; any number of threads may use it.
class Surfaces {
 public:
  /// The arguments must outlive this object.
  Surfaces(const Scene& scene, const Primitives& primitives, const SurfaceFinder& finder,
           SharedTextures& textures);

  [[nodiscard]] const SurfaceFinder& finder() const { return finder_; }
  [[nodiscard]] Visibility visibility(PrimitiveId id) const { return entry_of(id).visibility; }

  [[nodiscard]] BaseColor base_color(const World& world, const Ray& ray, const Hit& hit) const;

  /// A faster base_color() for surfaces without textures and vertex colors, which are the most
  /// common ones. Null for other surfaces.
  [[nodiscard]] const Vec3* plain_color(const Ray& ray, const Hit& hit) const {
    const Entry& entry = entry_of(hit.id);
    if (entry.kind == Kind::various) return nullptr;
    if (entry.kind == Kind::one_sided && !is_front(ray, hit)) return nullptr;
    return &entry.color;
  }

  /// The base color at all hits of a primitive, if its surface also has two sides. Null for other
  /// surfaces.
  [[nodiscard]] const Vec3* plain_color(PrimitiveId id) const {
    const Entry& entry = entry_of(id);
    return entry.kind == Kind::plain ? &entry.color : nullptr;
  }

  /// True if two hits of a ray are the same point of one surface. This happens on an edge or vertex
  /// shared by two triangles of a mesh that both face the ray with the same side.
  [[nodiscard]] bool is_same_point(const Ray& ray, const Hit& a, const Hit& b) const;

  /// True if a hit has coverage above 0.
  [[nodiscard]] bool is_visible(const World& world, const Ray& ray, const Hit& hit) const;

  /// See World::first_visible.
  [[nodiscard]] std::optional<Hit> first_visible(const World& world, const Ray& ray,
                                                 std::optional<Hit> hit) const;

 private:
  enum class Kind : std::uint8_t { plain, one_sided, various };
  struct Entry {
    Vec3 color;
    Kind kind;
    Visibility visibility;
  };

  [[nodiscard]] const Entry& entry_of(PrimitiveId id) const {
    const Object& object = *scene_.objects.run(primitives_.run_index(id)).first;
    const auto* mesh = std::get_if<Mesh>(&object.shape);
    const bool has_colors = mesh != nullptr && !mesh->colors.empty();
    return entries_[2 * object.material.value_or(none_) + (has_colors ? 1 : 0)];
  }
  [[nodiscard]] static Entry entry_of(const Material& material, bool has_colors);
  void make_map(std::uint32_t index, SharedTextures& textures);
  [[nodiscard]] bool is_front(const Ray& ray, const Hit& hit) const;
  [[nodiscard]] DVec4 texel(const World& world, const TextureUse& use, const Ray& ray,
                            const SurfaceInteraction& at) const;

  const Scene& scene_;
  const Primitives& primitives_;
  const SurfaceFinder& finder_;
  // By material, then for objects without a material; each for meshes without and with colors.
  std::vector<Entry> entries_;
  std::uint32_t none_;  // stands for objects without a material
  // By texture; nothing for textures that are white or not needed.
  std::vector<std::optional<TextureMap>> colors_;
};

}  // namespace microtrace
