#pragma once
/// Selects the camera according to the options.

#include "cli/arguments.hpp"

#include <microtrace/camera.hpp>
#include <microtrace/framing.hpp>
#include <microtrace/scene.hpp>

#include <cstddef>
#include <optional>

namespace microtrace::cli {

/// Returns the camera of --view or --eye if one of them is given; otherwise a camera that frames
/// the scenes added to `framing`. The camera is in the coordinates of `framing`. Throws Error
/// (usage).
[[nodiscard]] PerspectiveCamera camera_of(const Framing& framing, const CameraOptions& options);

/// Returns the camera with the lens and the focus of the options. Throws Error (usage).
[[nodiscard]] Camera with_lens(Camera camera, const CameraOptions& options);

/// Returns the index of the scene's camera that the options select: by default, the first. Nothing
/// if there is none or if the options describe a camera.
[[nodiscard]] std::optional<std::size_t> camera_index(const Scene& scene,
                                                      const CameraOptions& options);

/// Returns the camera that the options select, or the scene's default camera. If the scene has no
/// such camera, throws Error (usage) with the names of the scene's cameras.
[[nodiscard]] Camera choose_camera(const Scene& scene, const CameraOptions& options,
                                   ImageSize size);

/// Converts a camera from world coordinates to the scene's coordinates (see Scene::origin).
[[nodiscard]] PerspectiveCamera in_coordinates_of(const Scene& scene, PerspectiveCamera camera);

}  // namespace microtrace::cli
