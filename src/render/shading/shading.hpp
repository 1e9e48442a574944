#pragma once
/// Material evaluation at the vertices of paths.

#include "render/bsdf/parameters.hpp"
#include "render/kernels/kernel.hpp"
#include "render/media/medium.hpp"
#include "render/shading/flat_triangles.hpp"
#include "render/shading/surface_point.hpp"
#include "render/textures/texture_map.hpp"
#include "render/textures/textured_lanes.hpp"
#include "scene/material_textures.hpp"
#include "simd/vector_types.hpp"

#include <microtrace/material.hpp>
#include <microtrace/scene.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace microtrace {

struct HitGroup;
struct ShadingPoint;

/// A use of a texture by a material.
struct TextureSlot {
  const TextureMap* map = nullptr;  ///< null if there is no texture
  const TextureUse* use = nullptr;
  float width_scale = 1;  ///< of footprint widths by use->texture_from_uv
  /// True if its texel address equals that of TexturedMaterial::layout.
  bool shares_address = false;

  /// The linear texel value; white if there is no texture.
  [[nodiscard]] Vec4 at(const ShadingPoint& point) const {
    return map == nullptr ? Vec4(1) : look_up(point);
  }
  [[nodiscard]] TexelAddress<1> texel_address(const ShadingPoint& point) const;
  /// The texel address at a point of the mesh's texture coordinates. `width` is the footprint's
  /// width in these coordinates.
  [[nodiscard]] TexelAddress<1> texel_address(const Vec2& uv, float width) const;

 private:
  [[nodiscard]] Vec4 look_up(const ShadingPoint& point) const;
};

/// The input of a BSDF at a point.
struct BsdfInput {
  bsdf::Parameters parameters;
  bsdf::Layers layers;
  bsdf::Features features;

  BsdfInput(const bsdf::Parameters& p, const bsdf::Layers& l)
      : parameters(p), layers(l), features(features_of(p, l)) {}
};

/// A material with its textures.
struct TexturedMaterial {
  /// The textures that most materials have.
  static constexpr std::array kFrequent = {MaterialTexture::base_color,
                                           MaterialTexture::metallic_roughness,
                                           MaterialTexture::normal, MaterialTexture::emissive};

  const Material* material = nullptr;
  std::array<TextureSlot, static_cast<std::size_t>(MaterialTexture::count)> slots{};
  /// The slot whose texel address is reused by every slot with shares_address. Often these are all
  /// slots.
  TextureSlot layout{};
  Medium medium{};  ///< the enclosed medium, if encloses_medium()
  /// True if the emitted radiance is the same everywhere on the front, and no part is transparent.
  bool has_constant_emission = false;
  bool has_open_back = false;  ///< true if Backfaces::pass lets light pass through the back
  /// As has_open_back, but only where the textures of all transmission are 0.
  bool has_open_opaque_parts = false;
  /// True if constant_but_textures is set, the roughness is not given as glossiness, and the
  /// material is neither unlit nor emissive, except by a texture.
  bool is_simple = false;
  bool is_textured = false;  ///< true if the material has textures
  /// True if the material has textures or an alpha mode, so that points differ.
  bool varies = false;
  bool has_back = false;  ///< has_back(*material)
  /// True if coverage() is 1 everywhere for rays other than camera rays, and there are no open
  /// opaque parts.
  bool is_opaque = false;
  /// The BSDF's input for white texels, if it depends on nothing but textures of kFrequent with
  /// texture coordinates of set 0 on meshes without vertex colors.
  std::optional<BsdfInput> constant_but_textures{};
  /// The material for kernels. Except for camera rays, emission and alpha are those of
  /// ShadingPoint::unfiltered().
  struct KernelSurfaces {
    TexturedSurface from_camera, from_others;
  };
  /// Set if constant_but_textures is set and either the material varies or meshes with it have
  /// vertex colors.
  std::shared_ptr<const KernelSurfaces> kernel_surfaces{};

  [[nodiscard]] TextureSlot& operator[](MaterialTexture texture) {
    return slots[static_cast<std::size_t>(texture)];
  }
  [[nodiscard]] const TextureSlot& operator[](MaterialTexture texture) const {
    return slots[static_cast<std::size_t>(texture)];
  }

  /// True if a texture is not one of kFrequent, or uses other texture coordinates than set 0.
  [[nodiscard]] bool has_rare_textures() const;
  /// Prefetches the texels of all slots with shares_address.
  void fetch(const TexelAddress<1>& address) const;

  [[nodiscard]] bool is_emissive() const { return microtrace::is_emissive(*material); }
};

/// A shading point, its material, and the width of its footprint.
struct ShadingPoint {
  SurfacePoint at;
  const TexturedMaterial* look = nullptr;
  float width = 0;  ///< footprint width in world space
  /// The texel address that slots share, if it has been computed.
  std::optional<TexelAddress<1>> texel_address{};

  /// The point with a footprint of width 0.
  [[nodiscard]] ShadingPoint unfiltered() const { return {.at = at, .look = look}; }
};

/// True if the back of the material is visible, from behind or from inside its medium.
[[nodiscard]] inline bool has_back(const Material& m) {
  return m.double_sided || encloses_medium(m);
}

class SharedTables;
class TextureMaps;

/// Evaluates materials. Created once per picture. Any number of threads may use it.
class Shading {
 public:
  /// All arguments must outlive this object.
  Shading(const Scene& scene, const Primitives& primitives, SharedTables& tables);
  ~Shading();

  /// The shading point of `hit`, which must be a hit of `ray`. Its width is set to 0.
  [[nodiscard]] ShadingPoint point(const Ray& ray, const Hit& hit) const;
  /// Finds the points of the hits group.hit of primitives `ids`. The caller has set the rays in
  /// group.lanes.
  void find_points(const ShadingKernels& kernels, std::span<const PrimitiveId, kShadingLanes> ids,
                   HitGroup& group) const;
  /// Sets the surfaces of group.flat in their lanes, and any values in the other lanes.
  void load_surfaces(const ShadingKernels& kernels, const HitGroup& group,
                     SurfaceLanes& surface) const;
  /// The shading point in a lane of a group, for which find_points() was called. Its width is 0.
  [[nodiscard]] ShadingPoint point(const HitGroup& group, int lane, const Ray& ray,
                                   const Hit& hit) const;

  /// A point on a mesh triangle without a ray, for evaluating emission. For other shapes, on which
  /// emission is constant, only the side is set.
  [[nodiscard]] ShadingPoint point_on(PrimitiveId id, const Vec3& barycentrics, bool front,
                                      float width) const;

  [[nodiscard]] const Material& material(PrimitiveId id) const {
    return *looks_[entries_[primitives_.object_index(id)].look].material;
  }

  /// Computes the texel address that textures share at the point, and prefetches the texels.
  static void find_texel_address(ShadingPoint& point);

  /// The opacity at the point. It is the base color's alpha if the material uses alpha. For camera
  /// rays, one-sided surfaces are transparent from behind.
  [[nodiscard]] float coverage(const ShadingPoint& point, bool from_camera) const;
  /// The opacity of a visible side where the base color has this alpha.
  [[nodiscard]] static float coverage(const Material& material, float alpha);
  /// The least alpha for which coverage() is 1.
  [[nodiscard]] static float covering_alpha(const Material& material);

  /// True if TexturedMaterial::is_opaque is true for the materials of all objects.
  [[nodiscard]] bool all_cover() const { return all_cover_; }

  /// True if light arrives through the surface on the point's side when backs pass light. This is
  /// the case on the front of a one-sided surface that is neither emissive nor transmissive at this
  /// point.
  [[nodiscard]] static bool lets_light_in(const ShadingPoint& point) {
    return point.at.front && (point.look->has_open_back ||
                              (point.look->has_open_opaque_parts && is_opaque_part(point)));
  }
  /// True if a material has textures, so that the footprints of paths matter.
  [[nodiscard]] bool has_textures() const { return has_textures_; }
  /// True if there are surfaces with TexturedMaterial::has_open_back. TexturedMaterial::is_opaque
  /// is false for those with has_open_opaque_parts, so no shadow ray takes a shortcut there.
  [[nodiscard]] bool has_open_backs() const { return has_open_backs_; }

  /// The triangles with open backs, one bit per primitive. Null if there are none, or if other
  /// primitives have open backs.
  [[nodiscard]] const std::uint32_t* open_fronts() const {
    return open_fronts_.empty() ? nullptr : open_fronts_.data();
  }
  /// True if the primitive blocks all light that doesn't arrive through an open back.
  [[nodiscard]] bool is_opaque(PrimitiveId id) const {
    return all_cover_ || looks_[entries_[primitives_.object_index(id)].look].is_opaque;
  }
  /// True if the primitive may be emissive.
  [[nodiscard]] bool is_emissive(PrimitiveId id) const {
    return looks_[entries_[primitives_.object_index(id)].look].is_emissive();
  }
  /// True if both primitives are of one object, whose material may be emissive.
  [[nodiscard]] bool is_same_emitter(PrimitiveId a, PrimitiveId b) const {
    return primitives_.object_index(a) == primitives_.object_index(b) && is_emissive(a);
  }
  [[nodiscard]] bool is_open_front(PrimitiveId id) const {
    return (open_fronts_[id / 32] >> id % 32 & 1U) != 0;
  }

  /// The radiance emitted toward the ray's origin; 0 on the back of one-sided surfaces. Unlit
  /// materials emit their color.
  [[nodiscard]] Vec3 emission(const ShadingPoint& point) const;

  /// Returns the BSDF's input on the ray's side. Unless it is constant, it is computed and stored
  /// in `varying`. `channel` is the color channel of a path through dispersive media, 0 to 2; 3 for
  /// all channels. `outside` is the medium around a body that encloses a medium; null for a vacuum.
  [[nodiscard]] const BsdfInput& bsdf_input(const ShadingPoint& point, int channel,
                                            const Medium* outside,
                                            std::optional<BsdfInput>& varying) const {
    const bool has_colors = point.at.mesh != nullptr && !point.at.mesh->colors.empty();
    const TexturedMaterial& look = *point.look;
    if (look.constant_but_textures && !look.is_textured && !has_colors)
      return *look.constant_but_textures;
    return varying.emplace(parameters(point, channel, outside), layers(point));
  }

  /// The medium that the surface encloses; null if there is none.
  [[nodiscard]] static const Medium* enclosed_medium(const ShadingPoint& point) {
    return encloses_medium(*point.look->material) ? &point.look->medium : nullptr;
  }

 private:
  struct Entry {
    const Mesh* mesh;
    PrimitiveId first_id;
    std::uint32_t look;
  };

  [[nodiscard]] static bsdf::Parameters parameters(const ShadingPoint& point, int channel,
                                                   const Medium* outside);
  [[nodiscard]] static bsdf::Layers layers(const ShadingPoint& point);
  [[nodiscard]] static Vec4 base_color(const ShadingPoint& point);
  void find_open_fronts();
  static void add_anisotropy(const ShadingPoint& point, bsdf::Parameters& p);
  /// True if the surface transmits no light at the point, or only diffusely, because it has no
  /// transmission or the transmission texture is 0.
  [[nodiscard]] static bool lacks_glass(const ShadingPoint& point);
  /// True if the surface transmits no light at the point.
  [[nodiscard]] static bool is_opaque_part(const ShadingPoint& point);

  const Primitives& primitives_;
  std::unique_ptr<TextureMaps> maps_;
  // By material, then for objects without a material, then for closed shapes whose material is
  // one-sided.
  std::vector<TexturedMaterial> looks_;
  std::vector<Entry> entries_;  // by object
  FlatTriangles flat_triangles_;
  std::vector<std::uint32_t> open_fronts_;
  bool all_cover_ = true, has_open_backs_ = false, has_textures_ = false;
};

}  // namespace microtrace
