#pragma once
/// The scenes of the comparison with Embree.

#include <microtrace/camera.hpp>
#include <microtrace/scene.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace microtrace::bench {

/// A scene of meshes.
struct BenchScene {
  std::string name;
  Scene scene;
  PerspectiveCamera camera;
};

/// The names of the scenes in the order of the runs.
[[nodiscard]] const std::vector<std::string>& generated_scene_names();

/// Makes sphere (1 M triangles), hall (1 M, seen from inside), terrain (10 M), or field (a thousand
/// instances of a sphere of 100 000). `small` divides these numbers of triangles by 100. Throws
/// std::invalid_argument for other names.
[[nodiscard]] BenchScene generated_scene(const std::string& name, bool small);

/// Returns a displaced sphere with about this number of triangles.
[[nodiscard]] BenchScene sphere_scene(std::size_t triangles);

/// Returns all triangles of a glTF or JSON scene, viewed diagonally. Throws Error if the scene
/// can't be read, and std::invalid_argument if it has no triangles.
[[nodiscard]] BenchScene scene_from_file(const std::string& path);

}  // namespace microtrace::bench
