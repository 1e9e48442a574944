#pragma once
/// Motion blur of animated scenes.

#include "cli/arguments.hpp"
#include "cli/pictures/render_picture.hpp"

#include <microtrace/camera.hpp>
#include <microtrace/environment.hpp>
#include <microtrace/io.hpp>
#include <microtrace/scene.hpp>
#include <microtrace/shutter.hpp>

#include <optional>

namespace microtrace::cli {

/// A picture whose scene moves.
struct MovingPicture {
  SceneFile& file;
  const Arguments& arguments;
  const std::optional<Environment>& environment;  ///< of --env
  Tables& tables;                                 ///< those of the latest scene
  double time;                                    ///< of the picture, seconds
  ImageSize size;
};

/// Returns the shutter of a picture, absent without --shutter and for scenes without animations,
/// which look the same with any shutter. `scene` and `camera` are those at the time of the picture.
/// If the camera is one of the scene's, it moves with the scene; otherwise it stays where it is.
/// The result refers to the members of `picture`, which must outlive it.
[[nodiscard]] std::optional<Shutter> shutter_of(const MovingPicture& picture, const Scene& scene,
                                                const Camera& camera);

}  // namespace microtrace::cli
