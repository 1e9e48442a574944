#pragma once
/// Scenes typical of architecture and CAD: axis-aligned walls, and faces that touch, share edges or
/// are coplanar. Filters are most often unsure there. The same bits on every machine.

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
  DVec3 light{0};           ///< a point just off the emitter, on its front
  std::vector<Pose> views;  ///< the first in an oblique direction, the second along an axis
};

/// room: 14 boxes on each other, on the floor and against the walls, on a grid of 0.1;
/// voxels: a third of 16 x 16 x 16 cubes, 12 triangles each, shared faces twice;
/// plates: stacked plates with holes and steps, on a grid of 0.1;
/// terrain: 96 x 96 cells with heights in steps of 1/16;
/// tiles, inexact tiles: a room of single quads on a grid of 1/4, or with corners that are sums of
/// 0.1, so that edges differ by roundings;
/// skewed room: the room with coordinates off by a few units in the last place or by 1e-6.
[[nodiscard]] const std::vector<std::string>& architecture_names();

/// Throws std::invalid_argument for another name.
[[nodiscard]] ArchitectureScene architecture(const std::string& name);

/// The scene rotated by an odd angle in float64 and rounded once, with its emitter and its views.
[[nodiscard]] ArchitectureScene turned(ArchitectureScene scene);

/// The mesh and the emitter, numbered in this order, with diffuse materials.
[[nodiscard]] Scene as_scene(const ArchitectureScene& architecture);

}  // namespace microtrace::generated
