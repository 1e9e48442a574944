#pragma once
/// What the surfaces of a scene look like to a ray, before any light.

#include "render/texture_map.hpp"

#include <microtrace/bvh.hpp>
#include <microtrace/camera.hpp>
#include <microtrace/hit.hpp>
#include <microtrace/math.hpp>
#include <microtrace/primitives.hpp>
#include <microtrace/ray.hpp>
#include <microtrace/scene.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace microtrace {

struct SurfaceInteraction;

/// Made once for a picture; any number of threads may ask it.
class Surfaces {
 public:
  /// All must outlive this. Images are filtered for rays of that camera, of which each pixel has
  /// so many.
  Surfaces(const Scene& scene, const Primitives& primitives, const RayGenerator& camera,
           std::uint32_t samples, TexturePyramids& pyramids);

  /// The same for another number of samples.
  Surfaces(const Surfaces& other, std::uint32_t samples);

  /// The base colour of what the ray hits, linear Rec. 709, and how much of it is there: alpha 0
  /// where the surface is seen from a side that it lacks or lies under its material's cutoff, 1
  /// where it hides all behind it (glTF 2.0, sections 3.9.4 and 3.9.6).
  [[nodiscard]] Vec4 look(const Ray& ray, const Hit& hit) const;

  /// The same where it takes no textures and vertex colours, and the ray need go no further; in
  /// most pictures most hits. Sooner. Null elsewhere.
  [[nodiscard]] const Vec3* plain_look(const Ray& ray, const Hit& hit) const {
    const Entry& entry = entries_[primitives_.object_index(hit.id)];
    if (entry.kind == Kind::various) return nullptr;
    if (entry.kind == Kind::one_sided && !is_front(ray, hit)) return nullptr;
    return &entry.color;
  }

  /// Whether two hits of one ray are one point of one surface: on the edge or corner that two
  /// triangles of a mesh share, with the same side to the ray.
  [[nodiscard]] bool is_same_point(const Ray& ray, const Hit& a, const Hit& b) const;

  /// Of `hit` and those after it the first that is there at all: with alpha above 0.
  [[nodiscard]] std::optional<Hit> first_seen(const Bvh& bvh, const Ray& ray,
                                              std::optional<Hit> hit) const;

 private:
  enum class Kind : std::uint8_t { plain, one_sided, various };
  struct Entry {
    Vec3 color;
    Kind kind;
  };

  void make_map(std::uint32_t index, TexturePyramids& pyramids);
  [[nodiscard]] bool is_front(const Ray& ray, const Hit& hit) const;
  [[nodiscard]] DVec4 texel(const TextureUse& use, const Ray& ray,
                            const SurfaceInteraction& at) const;

  const Scene& scene_;
  const Primitives& primitives_;
  const RayGenerator& camera_;
  double sample_width_;         // of a pixel
  std::vector<Entry> entries_;  // by object
  // By texture; nothing: white, or not needed.
  std::shared_ptr<std::vector<std::optional<TextureMap>>> colors_;
};

}  // namespace microtrace
