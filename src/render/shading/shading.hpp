#pragma once
/// Material evaluation at hits: BSDFs, emission and coverage.

#include "accel/kernels/kernel.hpp"
#include "base/bit_set.hpp"
#include "render/lanes/shading_kernels.hpp"
#include "render/shading/opacity_maps.hpp"
#include "render/shading/points/flat_triangles.hpp"
#include "render/shading/points/footprint.hpp"
#include "render/shading/primitive_set.hpp"
#include "render/shading/textured_material.hpp"
#include "simd/vector_types.hpp"

#include <microtrace/material.hpp>
#include <microtrace/path.hpp>
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

/// A triangle of a mesh.
struct MeshTriangle {
  PlacedMesh mesh{};
  std::size_t index = 0;
};

class SharedTextures;
class TextureMaps;

/// Evaluates materials. Created once per prepared scene, when it is first needed. Any number of
/// threads may use it.
class Shading {
 public:
  /// All arguments must outlive this object.
  Shading(const Scene& scene, const Primitives& primitives, SharedTextures& textures);
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
  /// The front of a point on a mesh triangle, for evaluating emission and coverage without a
  /// footprint.
  [[nodiscard]] ShadingPoint texture_point(PrimitiveId id, const Vec3& barycentrics) const;

  [[nodiscard]] const Material& material(PrimitiveId id) const { return *look_of(id).material; }

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

  /// The triangles with open backs, or none if other primitives have open backs.
  [[nodiscard]] BitPages triangles_with_open_backs() const { return with_open_backs_.pages(); }
  /// True if the primitive blocks all light that doesn't arrive through an open back.
  [[nodiscard]] bool is_opaque(PrimitiveId id) const { return all_cover_ || look_of(id).is_opaque; }
  /// True if the primitive may be emissive.
  [[nodiscard]] bool is_emissive(PrimitiveId id) const { return look_of(id).is_emissive(); }
  /// True if both primitives are of one object, whose material may be emissive.
  [[nodiscard]] bool is_same_emitter(PrimitiveId a, PrimitiveId b) const {
    return primitives_.object_index(a) == primitives_.object_index(b) && is_emissive(a);
  }
  [[nodiscard]] bool has_open_back(PrimitiveId id) const {
    return is_in(triangles_with_open_backs(), id);
  }

  /// The unit shading normal on the side from which a ray in direction d arrives.
  [[nodiscard]] static Vec3 normal(const ShadingPoint& point, const Vec3& d);
  /// The fraction of the light that crosses a clear surface at the point, opposite to d. The
  /// surface reflects, scatters or absorbs the rest.
  [[nodiscard]] Vec3 crossing_light(const ShadingPoint& point, const Vec3& d,
                                    BsdfModel model) const;
  /// The fraction of the light that arrives at the ray's origin through the surface, in a straight
  /// line. The ray must not be a camera ray.
  [[nodiscard]] Vec3 transmittance(const ShadingPoint& point, const Vec3& d, BsdfModel model) const;

  /// The triangles on which is_transparent() may be true, and all that have alphaMode BLEND or are
  /// clear. Those that enclose a medium are left out.
  [[nodiscard]] BitPages masked() const { return masked_.pages(); }
  [[nodiscard]] bool is_masked(PrimitiveId id) const { return is_in(masked(), id); }
  /// Whether one of these triangles has opacity at these weights, if that is known.
  [[nodiscard]] Visible known_visible(PrimitiveId id, const HitWeights& at) const;
  /// The opacity that alpha gives one of these triangles where the ray hits it. The ray must not be
  /// a camera ray.
  [[nodiscard]] float masked_coverage(const Ray& ray, PrimitiveId id) const;
  /// transmittance() of one of these triangles.
  [[nodiscard]] Vec3 masked_transmittance(const Ray& ray, PrimitiveId id, BsdfModel model) const;
  /// True if this opacity is 0.
  [[nodiscard]] bool is_transparent(const Ray& ray, PrimitiveId id) const {
    return masked_coverage(ray, id) == 0;
  }
  /// True if one of these triangles is clear or blends with what is behind it. If so, the light
  /// that passes it depends only on masked_transmittance(), unless it arrives through an open back.
  [[nodiscard]] bool is_blended(PrimitiveId id) const { return blends(look_of(id)); }
  /// True if there are such triangles.
  [[nodiscard]] bool has_blended() const { return has_blended_; }
  /// True if such a triangle has no opacity for a camera ray with this footprint. The result may
  /// also be false if that is difficult to decide.
  [[nodiscard]] bool is_transparent_to_camera(const Ray& ray, PrimitiveId id,
                                              const Footprint& footprint) const;
  /// True if the primitive has an opacity of 1 wherever is_transparent() is false, and blocks all
  /// light there that doesn't arrive through an open back.
  [[nodiscard]] bool blocks_unless_transparent(PrimitiveId id) const {
    if (all_cover_) return true;
    const Entry& entry = entry_of(id);
    const TexturedMaterial& look = looks_[entry.look];
    return look.is_opaque || (entry.has_maps() && look.is_opaque_if_visible);
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
    const bool has_colors = point.at.mesh && !point.at.mesh.arrays->colors.empty();
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
  static constexpr std::size_t kNoMap = ~std::size_t{0};
  /// The objects of a run.
  struct Entry {
    const Mesh* mesh;             // of the first; null if they are not meshes
    const Placement* placements;  // of each; null if there is only one
    PrimitiveId first_id;
    std::uint32_t look;
    // Of the triangles of a mesh that is not mirrored and of one that is, see OpacityMaps.
    std::array<std::size_t, 2> first_map{kNoMap, kNoMap};

    /// The mesh is without arrays if the primitive is not a triangle of one.
    [[nodiscard]] MeshTriangle triangle(PrimitiveId id) const {
      const PrimitiveId index = id - first_id;
      if (mesh == nullptr) return {};
      if (placements == nullptr) return {.mesh = *mesh, .index = index};
      const auto size = static_cast<PrimitiveId>(mesh->triangles.size());
      return {.mesh = {*mesh, placements + index / size}, .index = index % size};
    }
    [[nodiscard]] std::size_t& first_map_of(const PlacedMesh& of) {
      return first_map[of.is_mirrored() ? 1 : 0];
    }
    [[nodiscard]] std::size_t map(const MeshTriangle& of) const {
      return first_map[of.mesh.is_mirrored() ? 1 : 0] + of.index;
    }
    [[nodiscard]] bool has_maps() const { return first_map != std::array{kNoMap, kNoMap}; }
  };
  /// Calls f(mesh, its lowest PrimitiveId) for the meshes of a run.
  template <class F>
  void for_each_mesh(std::size_t run, const F& f) const {
    const ObjectRun objects = primitives_.scene().objects.run(run);
    PrimitiveId id = entries_[run].first_id;
    for (std::size_t i = 0; i < objects.count; ++i) {
      const PlacedMesh mesh = objects.mesh(i);
      if (!mesh) return;
      f(mesh, id);
      id += static_cast<PrimitiveId>(mesh.arrays->triangles.size());
    }
  }

  [[nodiscard]] static bsdf::Parameters parameters(const ShadingPoint& point, int channel,
                                                   const Medium* outside);
  [[nodiscard]] static bsdf::Layers layers(const ShadingPoint& point);
  [[nodiscard]] static Vec4 base_color(const ShadingPoint& point);
  [[nodiscard]] const Entry& entry_of(PrimitiveId id) const {
    return entries_[primitives_.run_index(id)];
  }
  [[nodiscard]] const TexturedMaterial& look_of(PrimitiveId id) const {
    return looks_[entry_of(id).look];
  }
  void find_open_backs();
  void find_masked();
  [[nodiscard]] static float alpha_coverage(const ShadingPoint& point);
  [[nodiscard]] static bool blends(const TexturedMaterial& look) {
    if (look.is_clear) return !look.has_open_opaque_parts;
    return look.depends_on_alpha && look.material->alpha_mode == AlphaMode::blend;
  }
  [[nodiscard]] static Vec3 normal(const ShadingPoint& point, const Vec3& d,
                                   MaterialTexture texture, float scale);
  struct MaskedHit;
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
  std::vector<Entry> entries_;  // by run of objects
  FlatTriangles flat_triangles_;
  PrimitiveSet with_open_backs_, masked_;
  OpacityMaps opacity_;
  bool all_cover_ = true, has_open_backs_ = false, has_textures_ = false, has_blended_ = false;
};

}  // namespace microtrace
