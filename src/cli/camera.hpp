#pragma once
/// The camera that the command line asks for.

#include "cli/arguments.hpp"

#include <microtrace/camera.hpp>
#include <microtrace/framing.hpp>
#include <microtrace/scene.hpp>

namespace microtrace::cli {

/// The camera of --view or --eye, else one that frames the scenes added to `framing`; in the
/// framing's coordinates. Throws Error (usage).
[[nodiscard]] PerspectiveCamera camera_of(const Framing& framing, const CameraOptions& options);

/// The camera that the options ask for, else the scene's default. Throws Error (usage) with the
/// names of the scene's cameras.
[[nodiscard]] Camera choose_camera(const Scene& scene, const CameraOptions& options,
                                   ImageSize size);

}  // namespace microtrace::cli
