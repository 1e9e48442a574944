#pragma once
/// Options that say where a picture is seen from.

#include "cli/option_values.hpp"

#include <microtrace/camera.hpp>
#include <microtrace/framing.hpp>
#include <microtrace/math.hpp>
#include <microtrace/scene.hpp>

#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace microtrace::cli {

/// What the options name; at most one of camera, orbit and eye.
struct Viewpoint {
  std::string camera;  ///< of the scene, by name or index; empty: the first
  std::optional<OrbitView> orbit{};
  std::optional<DVec3> eye{};
  std::optional<DVec3> target{};              ///< absent: the middle of the scene's bounding box
  DVec3 up{0, 1, 0};                          ///< of the eye
  double vertical_fov = View{}.vertical_fov;  ///< of orbit and eye, degrees

  [[nodiscard]] bool is_of_scene() const { return !orbit && !eye; }
};

/// Adds the options; finish_camera reads them once the app has parsed. Both throw CLI::Error.
void add_camera_options(CLI::App& app, Viewpoint& viewpoint);
void finish_camera(const CLI::App& app, Viewpoint& viewpoint);

/// What a camera that is none of the scene's is to see; scenes are then added.
[[nodiscard]] Framing framing_for(const Viewpoint& viewpoint, ImageSize size);

/// The camera that --view or --eye asks for, else the scenes framed, in the framing's coordinates.
/// Throws Error (usage).
[[nodiscard]] PerspectiveCamera camera_of(const Framing& framing, const Viewpoint& viewpoint);

/// The camera that the options ask for, else the scene's default. Throws Error (usage) with the
/// names there are.
[[nodiscard]] Camera choose_camera(const Scene& scene, const Viewpoint& viewpoint, ImageSize size);

}  // namespace microtrace::cli
