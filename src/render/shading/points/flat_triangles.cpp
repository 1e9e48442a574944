#include "render/shading/points/flat_triangles.hpp"

#include "base/memory_account.hpp"
#include "render/shading/points/find_points.hpp"
#include "render/shading/points/hit_lanes.hpp"
#include "render/shading/shading.hpp"

namespace microtrace {
namespace {

/// A triangle that is seen from nowhere.
const FlatTriangle kNone{.corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .n = {0, 0, 1}};

bool has_attributes(const Mesh& mesh) {
  return !mesh.normals.empty() || !mesh.tangents.empty() || !mesh.uv_sets.empty() ||
         !mesh.colors.empty();
}

bool is_simple(const TexturedMaterial& look) {
  return look.is_simple && look.is_opaque && !look.is_emissive() &&
         look.constant_but_textures->features.index() == 0;
}

std::uint32_t kind_of(const TexturedMaterial& look) {
  return (is_simple(look) ? FlatTriangle::kSimple : 0) |
         (look.has_back ? FlatTriangle::kHasBack : 0) |
         (look.has_open_back ? FlatTriangle::kHasOpenBack : 0);
}

}  // namespace

void FlatTriangles::add_surface(const TexturedMaterial& look) {
  FlatSurface& surface = surfaces_.emplace_back();
  if (!is_simple(look)) return;
  const bsdf::Parameters& p = look.constant_but_textures->parameters;
  surface = {.base_color = {p.base_color.x, p.base_color.y, p.base_color.z},
             .metallic = p.metallic,
             .roughness = p.roughness,
             .f0 = {p.dielectric.f0.x, p.dielectric.f0.y, p.dielectric.f0.z},
             .f90 = p.dielectric.f90};
}

void FlatTriangles::add_mesh(const PlacedMesh& placed, PrimitiveId first, std::uint32_t surface,
                             const TexturedMaterial& look) {
  const Mesh& mesh = *placed.arrays;
  const std::size_t end = std::size_t{first} + mesh.triangles.size();
  const bool can_be_flat =
      !has_attributes(mesh) && !look.varies && (is_simple(look) || look.is_emissive());
  if (!can_be_flat || end > kMostPrimitives ||
      triangles_.size() + mesh.triangles.size() > kMostTriangles)
    return;
  take_memory(
      (end - rows_.size()) * sizeof(rows_[0]) + mesh.triangles.size() * sizeof(FlatTriangle),
      "the flat triangles of the scene");
  if (triangles_.empty()) triangles_.push_back(kNone);
  rows_.resize(end);
  HitArrays<1> lane{};
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    put_positions(lane, 0, placed, placed.corners(i));
    find_points<1>(lane);
    FlatTriangle& row =
        triangles_.emplace_back(FlatTriangle{.n = {lane.n[0][0], lane.n[1][0], lane.n[2][0]},
                                             .is_flat = 1,
                                             .surface = surface,
                                             .kind = kind_of(look)});
    for (int corner = 0; corner < 3; ++corner) {
      for (int axis = 0; axis < 3; ++axis)
        row.corners[corner][axis] = lane.corners[corner][axis][0];
    }
    rows_[first + i] = static_cast<std::uint32_t>(triangles_.size() - 1);
  }
}

Lanes FlatTriangles::find(std::span<const PrimitiveId, kShadingLanes> ids, Lanes lanes,
                          FlatHits& hits) const {
  if (rows_.empty()) return 0;
  Lanes flat = 0;
  for (std::size_t lane = 0; lane < kShadingLanes; ++lane) {
    const bool is_hit = (lanes >> lane & 1U) != 0;
    const std::uint32_t row = is_hit && ids[lane] < rows_.size() ? rows_[ids[lane]] : 0;
    hits.rows[lane] = row;
    flat |= Lanes{row != 0} << lane;
  }
  return flat;
}

}  // namespace microtrace
