#pragma once
/// What materials say at the points that paths meet.

#include "render/bsdf/bsdf.hpp"
#include "render/bsdf/frame.hpp"
#include "render/bsdf/layered.hpp"
#include "render/kernels/kernel.hpp"
#include "render/shading/surface_point.hpp"
#include "render/texture_map.hpp"

#include <microtrace/material.hpp>
#include <microtrace/scene.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace microtrace {

struct ShadingPoint;

/// A texture where a material uses it.
struct TextureSlot {
  const TextureMap* map = nullptr;  ///< null: white
  const TextureUse* use = nullptr;
  bool shares_place = false;  ///< with TexturedMaterial::layout

  /// Linear; white where there is none.
  [[nodiscard]] Vec4 at(const ShadingPoint& point) const {
    return map == nullptr ? Vec4(1) : look_up(point);
  }
  [[nodiscard]] TextureMap::Place place(const ShadingPoint& point) const;

 private:
  [[nodiscard]] Vec4 look_up(const ShadingPoint& point) const;
};

/// A material with its textures at hand. To take another texture: a slot here, its line in
/// texture_slots.cpp.
struct TexturedMaterial {
  const Material* material = nullptr;
  TextureSlot base_color{}, metallic_roughness{}, normal{}, emissive{};
  TextureSlot specular{}, specular_color{}, transmission{};
  TextureSlot diffuse_transmission{}, diffuse_transmission_color{};
  TextureSlot clearcoat{}, clearcoat_roughness{}, clearcoat_normal{};
  TextureSlot sheen_color{}, sheen_roughness{}, anisotropy{};
  TextureSlot iridescence{}, iridescence_thickness{}, specular_glossiness{};
  /// That by which the places of all that share them are found; often it is all.
  TextureSlot layout{};
  Vec3 absorption{0};          ///< by the medium that it encloses, in powers of two per length
  bool is_plain = false;       ///< Shading::plain_parameters() say all
  bool has_open_back = false;  ///< light passes it where Backfaces::pass says so

  [[nodiscard]] bool shines() const { return material->emissive != Vec3(0) && !material->unlit; }
};

/// A point, its material and how wide the part of the surface is that it stands for.
struct ShadingPoint {
  SurfacePoint at;
  const TexturedMaterial* look = nullptr;
  float width = 0;  ///< world space
  /// Where those textures are looked up that share their places, if that is known.
  std::optional<TextureMap::Place> place{};
};

/// Whether light is refracted into the surface and out at its back (KHR_materials_volume).
[[nodiscard]] inline bool encloses_medium(const Material& m) {
  return m.transmission && m.volume && m.volume->thickness > 0;
}

/// Whether the material has a back to be seen: from behind, or from within what it encloses.
[[nodiscard]] inline bool has_back(const Material& m) {
  return m.double_sided || encloses_medium(m);
}

class TextureMaps;

/// Made once for a picture; any number of threads may ask it.
class Shading {
 public:
  /// All must outlive this.
  Shading(const Scene& scene, const Primitives& primitives, TexturePyramids& pyramids);
  ~Shading();

  /// `hit` is one of `ray`. The width is 0.
  [[nodiscard]] ShadingPoint point(const Ray& ray, const Hit& hit) const;
  /// The same for each of up to kShadingLanes hits; points without a hit are left alone. `lanes`
  /// are for the kernel.
  void points(const ShadingKernels& kernels, std::span<const Ray> rays,
              std::span<const std::optional<Hit>> hits, HitLanes& lanes,
              std::span<ShadingPoint> points) const;

  /// A point of a mesh's triangle, without a ray: for what shines. A shape of its own is the same
  /// all over: its point has a side alone.
  [[nodiscard]] ShadingPoint point_on(PrimitiveId id, const Vec3& barycentrics, bool front,
                                      float width) const;

  [[nodiscard]] const Material& material(PrimitiveId id) const {
    return *looks_[entries_[primitives_.object_index(id)].look].material;
  }

  /// Spares the textures of a point from finding their places one by one, and begins to fetch what
  /// they have there.
  static void find_place(ShadingPoint& point);

  /// How much of the surface is there: by the base color's alpha where the material says so. What
  /// is one-sided has no back for camera rays.
  [[nodiscard]] float coverage(const ShadingPoint& point, bool from_camera) const;

  /// Whether coverage() is 1 for every point of all materials, from both sides, save for the
  /// camera.
  [[nodiscard]] bool all_cover() const { return all_cover_; }

  /// Whether light comes out of the surface on the side of the point where backs pass light: the
  /// front of what is one-sided, and neither shines nor lets light through in another way.
  [[nodiscard]] static bool lets_light_in(const ShadingPoint& point) {
    return point.at.front && point.look->has_open_back;
  }
  /// Whether there are surfaces of that kind.
  [[nodiscard]] bool has_open_backs() const { return has_open_backs_; }

  /// Radiance that leaves the point to the side of the ray, none at the back of what is one-sided.
  /// Unlit materials leave their colour.
  [[nodiscard]] Vec3 emission(const ShadingPoint& point) const;

  /// On the ray's side, in the coordinates of frame(); `channel` is the one that a path through
  /// dispersing media is of, 0 to 2; 3: none.
  [[nodiscard]] bsdf::Parameters parameters(const ShadingPoint& point, const bsdf::Frame& frame,
                                            int channel) const;

  /// The same of materials that are metallic-roughness, ior and specular alone, or
  /// specular-glossiness.
  [[nodiscard]] bsdf::Parameters plain_parameters(const ShadingPoint& point) const;

  /// What lies over that, if anything does; `wo` in world space.
  [[nodiscard]] std::optional<bsdf::Layers> layers(const ShadingPoint& point,
                                                   const bsdf::Frame& frame, const Vec3& wo) const;

  /// The medium below the surface absorbs so much, in powers of two per length; 0 where there is
  /// none.
  [[nodiscard]] Vec3 absorption(const ShadingPoint& point) const;

  /// The shading normal on the ray's side, by the normal texture if there is one, with tangents.
  /// `wo`, of unit length, is above it.
  [[nodiscard]] bsdf::Frame frame(const ShadingPoint& point, const Vec3& wo) const;

 private:
  struct Entry {
    const Mesh* mesh;
    PrimitiveId first_id;
    std::uint32_t look;
  };

  [[nodiscard]] Vec4 base_color(const ShadingPoint& point) const;
  static void add_anisotropy(const ShadingPoint& point, const bsdf::Frame& frame,
                             bsdf::Parameters& p);

  const Primitives& primitives_;
  std::unique_ptr<TextureMaps> maps_;
  std::vector<TexturedMaterial> looks_;  // by material; the last for objects without
  std::vector<Entry> entries_;           // by object
  bool all_cover_ = true, has_open_backs_ = false;
};

}  // namespace microtrace
