#pragma once
/// Scenes typical of architecture and CAD: axis-aligned walls, and faces that touch, share edges or
/// are coplanar. In such scenes, filters are uncertain most often. The scenes have the same bits on
/// every machine.

#include <microtrace/camera.hpp>
#include <microtrace/math.hpp>
#include <microtrace/scene.hpp>
#include <microtrace/shape.hpp>

#include <string>
#include <vector>

namespace microtrace::generated {

struct ArchitectureScene {
  std::string name;
  Mesh mesh;                ///< surfaces that don't emit light
  Mesh lamp;                ///< two emissive triangles
  DVec3 light{0};           ///< a point just in front of the emitter
  std::vector<Pose> views;  ///< the first in an oblique direction, the second along an axis
};

/// The scenes are:
/// room: 14 boxes on each other, on the floor and against the walls, on a grid of 0.1
/// voxels: a third of 16 x 16 x 16 cubes of 12 triangles each; a face between two cubes occurs
/// twice
/// plates: stacked plates with holes and steps, on a grid of 0.1
/// terrain: 96 x 96 cells with heights in steps of 1/16
/// tiles: a room of separate quads on a grid of 1/4
/// inexact tiles: a room of separate quads whose corners are rounded sums of 0.1, so neighbors'
/// edges differ slightly
/// skewed room: the room with coordinates changed by a few units in the last place or by up to 1e-6
[[nodiscard]] const std::vector<std::string>& architecture_names();

/// Throws std::invalid_argument if no scene has this name.
[[nodiscard]] ArchitectureScene architecture(const std::string& name);

/// Rotates the scene, its emitter and its views by an angle that aligns with no axis. Computes in
/// float64 and rounds once.
[[nodiscard]] ArchitectureScene turned(ArchitectureScene scene);

/// Returns a scene of the mesh and the emitter, in this order, with diffuse materials.
[[nodiscard]] Scene as_scene(const ArchitectureScene& architecture);

}  // namespace microtrace::generated
