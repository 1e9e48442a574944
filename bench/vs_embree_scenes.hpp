#pragma once
/// The scenes of the comparison with Embree.

#include <microtrace/camera.hpp>
#include <microtrace/scene.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace microtrace::bench {

/// A scene with one mesh, so that both programs number triangles in the same way.
struct BenchScene {
  std::string name;
  Scene scene;
  PerspectiveCamera camera;

  [[nodiscard]] const Mesh& mesh() const { return std::get<Mesh>(scene.objects[0].shape); }
};

/// The names of the scenes in the order of the runs.
[[nodiscard]] const std::vector<std::string>& generated_scene_names();

/// Makes sphere (1 M triangles), hall (1 M, seen from inside) or terrain (10 M). `small` divides
/// these numbers by 100. Throws std::invalid_argument for other names.
[[nodiscard]] BenchScene generated_scene(const std::string& name, bool small);

/// Returns a displaced sphere with about this number of triangles.
[[nodiscard]] BenchScene sphere_scene(std::size_t triangles);

/// Returns all triangles of a glTF or JSON scene, viewed diagonally. Throws Error if the scene
/// can't be read, and std::invalid_argument if it has no triangles.
[[nodiscard]] BenchScene scene_from_file(const std::string& path);

}  // namespace microtrace::bench
