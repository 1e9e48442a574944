#pragma once
/// What the comparison with Embree looks at.

#include <microtrace/camera.hpp>
#include <microtrace/scene.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace microtrace::bench {

/// One mesh, so that both programs number its triangles alike.
struct BenchScene {
  std::string name;
  Scene scene;
  PerspectiveCamera camera;

  [[nodiscard]] const Mesh& mesh() const { return std::get<Mesh>(scene.objects[0].shape); }
};

/// The scenes' names, in the order they are run.
[[nodiscard]] const std::vector<std::string>& generated_scene_names();

/// sphere (1 M triangles), hall (1 M, seen from inside) or terrain (10 M); one hundredth of that if
/// `small`. Throws std::invalid_argument for another name.
[[nodiscard]] BenchScene generated_scene(const std::string& name, bool small);

/// The displaced sphere of about that many triangles.
[[nodiscard]] BenchScene sphere_scene(std::size_t triangles);

/// All triangles of a glTF or JSON scene, seen from the diagonal of their bounding box. Throws
/// Error if it can't be read, std::invalid_argument if it has no triangle.
[[nodiscard]] BenchScene scene_from_file(const std::string& path);

}  // namespace microtrace::bench
