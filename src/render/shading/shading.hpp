#pragma once
/// What materials say at the points that paths meet.

#include "render/bsdf/bsdf.hpp"
#include "render/bsdf/frame.hpp"
#include "render/shading/surface_point.hpp"
#include "render/texture_map.hpp"

#include <microtrace/material.hpp>
#include <microtrace/scene.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace microtrace {

/// A material with its textures at hand; null where it has none.
struct TexturedMaterial {
  const Material* material = nullptr;
  const TextureMap* base_color = nullptr;
  const TextureMap* metallic_roughness = nullptr;
  const TextureMap* normal = nullptr;
  const TextureMap* emissive = nullptr;
  /// One of them, if all have the same places at every point.
  const TextureMap* layout = nullptr;
  const TextureUse* layout_use = nullptr;
};

/// A point, its material and how wide the part of the surface is that it stands for.
struct ShadingPoint {
  SurfacePoint at;
  const TexturedMaterial* look = nullptr;
  float width = 0;  ///< world space
  /// Where the material's textures are looked up, if that is known and all the same.
  std::optional<TextureMap::Place> place{};
};

/// Made once for a picture; any number of threads may ask it.
class Shading {
 public:
  /// Both must outlive this.
  Shading(const Scene& scene, const Primitives& primitives);
  ~Shading();

  /// `hit` is one of `ray`; at distance 1 samples are `spread` apart, at 0 `begin`.
  [[nodiscard]] ShadingPoint point(const Ray& ray, const Hit& hit, float begin, float spread) const;

  /// A point of a mesh's triangle, without a ray: for what shines.
  [[nodiscard]] ShadingPoint point_on(PrimitiveId id, const Vec3& barycentrics, bool front,
                                      float width) const;

  [[nodiscard]] const Material& material(PrimitiveId id) const {
    return *looks_[entries_[primitives_.object_index(id)].look].material;
  }

  /// Spares the textures of a point from finding their places one by one.
  static void find_place(ShadingPoint& point);

  /// How much of the surface is there: 0 on a side that it lacks; by the base colour's alpha where
  /// the material says so.
  [[nodiscard]] float coverage(const ShadingPoint& point) const;

  /// Whether coverage() is 1 for every point of all materials, from both sides.
  [[nodiscard]] bool all_cover() const { return all_cover_; }

  /// Radiance that leaves the point to the side of the ray. Unlit materials leave their colour.
  [[nodiscard]] Vec3 emission(const ShadingPoint& point) const;

  [[nodiscard]] bsdf::Parameters parameters(const ShadingPoint& point) const;

  /// The shading normal on the ray's side, by the normal texture if there is one, with tangents.
  /// `wo`, of unit length, is above it.
  [[nodiscard]] bsdf::Frame frame(const ShadingPoint& point, const Vec3& wo) const;

 private:
  struct Maps;
  struct Entry {
    const Mesh* mesh;
    PrimitiveId first_id;
    std::uint32_t look;
  };

  [[nodiscard]] Vec4 base_color(const ShadingPoint& point) const;

  const Primitives& primitives_;
  std::unique_ptr<Maps> maps_;
  std::vector<TexturedMaterial> looks_;  // by material; the last for objects without
  std::vector<Entry> entries_;           // by object
  bool all_cover_ = true;
};

}  // namespace microtrace
