#pragma once
/// Selects the camera according to the options.

#include "cli/arguments.hpp"
#include "cli/pictures/sequence.hpp"

#include <microtrace/camera.hpp>
#include <microtrace/framing.hpp>
#include <microtrace/io.hpp>
#include <microtrace/scene.hpp>

#include <optional>

namespace microtrace::cli {

/// The camera of --view or --eye, or else one that frames the scenes added to `framing`, in the
/// framing's coordinates. Throws Error (usage).
[[nodiscard]] PerspectiveCamera camera_of(const Framing& framing, const CameraOptions& options);

/// The camera of the options, or else the scene's default. Throws Error (usage) with the names of
/// the scene's cameras.
[[nodiscard]] Camera choose_camera(const Scene& scene, const CameraOptions& options,
                                   ImageSize size);

/// One static camera that frames all pictures of a sequence, in world coordinates. Absent if the
/// sequence uses a camera of the scene or is a single picture. Poses the scene for every picture.
[[nodiscard]] std::optional<PerspectiveCamera> frame_all(SceneFile& file, const Sequence& sequence,
                                                         const Arguments& arguments);

/// Converts a camera from world coordinates to the scene's (see Scene::origin).
[[nodiscard]] PerspectiveCamera in_coordinates_of(const Scene& scene, PerspectiveCamera camera);

}  // namespace microtrace::cli
