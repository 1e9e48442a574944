#pragma once
/// Applies --exposure auto.

#include "cli/arguments.hpp"
#include "cli/pictures/sequence.hpp"

#include <microtrace/camera.hpp>
#include <microtrace/environment.hpp>
#include <microtrace/io.hpp>
#include <microtrace/prepared_scene.hpp>
#include <microtrace/render.hpp>
#include <microtrace/scene.hpp>

#include <optional>

namespace microtrace::cli {

/// Throws Error (usage) if the exposure is to be automatic, which `command` doesn't support.
void refuse_automatic_exposure(const DisplayOptions& display, const char* command);

/// Returns true if the exposure of pictures of this scene is automatic: on request, and by default
/// for glTF assets with lights.
[[nodiscard]] bool is_exposure_automatic(const DisplayOptions& display, const Scene& scene);

/// Returns the options with the exposure of the picture that render() would return for the other
/// arguments.
[[nodiscard]] DisplayOptions with_exposure(const DisplayOptions& display,
                                           const PreparedScene& scene, const Camera& camera,
                                           ImageSize size, const RenderOptions& options);

/// Returns the display options of a picture without replaced environment. An integrator of its own
/// traces the rays for the exposure, which don't count as rays of the picture.
[[nodiscard]] DisplayOptions with_exposure(const Arguments& arguments, const PreparedScene& scene,
                                           const Camera& camera, ImageSize size);

/// Returns the options with one exposure for all frames, so that they don't flicker: that of the
/// scene at 0 seconds. Runs that render different frames use the same exposure. `framing` is the
/// result of frame_all().
[[nodiscard]] DisplayOptions with_exposure_of_frames(
    SceneFile& file, const Arguments& arguments, const std::optional<Environment>& environment,
    const std::optional<PerspectiveCamera>& framing);

}  // namespace microtrace::cli
