#pragma once
/// Scenes with instances, and the same scenes with transformed copies.

#include "support/cases/adversarial_rays.hpp"

#include <microtrace/scene.hpp>

#include <array>
#include <utility>
#include <variant>

namespace microtrace::adversarial {

enum class PlacementKind {
  rigid,     // rotated, sometimes mirrored
  lattice,   // translated by integers, so that instances touch, coincide and are coplanar
  similar,   // scaled by powers of two up to 2^40
  affine,    // sheared, and scaled differently along each axis
  far_away,  // translated by 2^20 times the size of the mesh
  extreme,   // axes scaled by 2^-40 to 2^40, some by 0
  nested,    // the product of several placements
};
inline constexpr std::array kPlacementKinds = {
    PlacementKind::rigid,    PlacementKind::lattice, PlacementKind::similar, PlacementKind::affine,
    PlacementKind::far_away, PlacementKind::extreme, PlacementKind::nested};

[[nodiscard]] const char* name(PlacementKind kind);
[[nodiscard]] DMat4 placement(Random& random, PlacementKind kind);

struct PlacedScenes {
  Scene instanced, baked;

  void add(Shape shape) {
    instanced.objects.push_back({.name = "", .shape = shape});
    if (const auto* mesh = std::get_if<Mesh>(&shape)) shape = microtrace::baked(*mesh);
    baked.objects.push_back({.name = "", .shape = std::move(shape)});
  }
  /// Adds a run of instances.
  void add_run(Mesh mesh, const std::vector<Placement>& placements) {
    instanced.objects.push_back_run({.name = "", .shape = mesh}, placements);
    for (const Placement& placement : placements) {
      mesh.placement = std::make_shared<const Placement>(placement);
      baked.objects.push_back({.name = "", .shape = microtrace::baked(mesh)});
    }
  }
};

/// Returns a mesh whose copies share its arrays.
[[nodiscard]] Mesh shared_mesh(Random& random);

/// Returns scenes in which up to two meshes are placed up to six times each, some at the same
/// place, some in runs and some without their last triangles, with copies of the meshes and other
/// shapes.
[[nodiscard]] PlacedScenes random_placed_scenes(Random& random, PlacementKind kind);

}  // namespace microtrace::adversarial
