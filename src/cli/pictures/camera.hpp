#pragma once
/// The camera that the command line asks for.

#include "cli/arguments.hpp"
#include "cli/pictures/sequence.hpp"

#include <microtrace/camera.hpp>
#include <microtrace/framing.hpp>
#include <microtrace/io.hpp>
#include <microtrace/scene.hpp>

#include <optional>

namespace microtrace::cli {

/// The camera of --view or --eye, else one that frames the scenes added to `framing`; in the
/// framing's coordinates. Throws Error (usage).
[[nodiscard]] PerspectiveCamera camera_of(const Framing& framing, const CameraOptions& options);

/// The camera that the options ask for, else the scene's default. Throws Error (usage) with the
/// names of the scene's cameras.
[[nodiscard]] Camera choose_camera(const Scene& scene, const CameraOptions& options,
                                   ImageSize size);

/// The camera at rest that frames all pictures of a sequence of several, unless that is a camera of
/// the scene; in the world's coordinates. Poses the scene for each.
[[nodiscard]] std::optional<PerspectiveCamera> frame_all(SceneFile& file, const Sequence& sequence,
                                                         const Arguments& arguments);

/// The same camera in the scene's coordinates instead of the world's.
[[nodiscard]] PerspectiveCamera in_coordinates_of(const Scene& scene, PerspectiveCamera camera);

}  // namespace microtrace::cli
