#pragma once
/// Describes a picture as JSON text.

#include <microtrace/camera.hpp>
#include <microtrace/export.hpp>
#include <microtrace/film.hpp>
#include <microtrace/scene.hpp>
#include <microtrace/shutter.hpp>

#include <optional>
#include <string>

namespace microtrace {

/// Returns the camera, the objects with the ids of Aov::id, and the materials as JSON text;
/// docs/outputs.md describes the members. `picture` is the picture's name in the text. If the film
/// has the channel "id.instance", each object also has the number and the bounding box of the
/// pixels that show it. `shutter` is absent if the picture has no motion blur.
[[nodiscard]] MICROTRACE_EXPORT std::string describe_picture(
    const Scene& scene, const Camera& camera, const Film& film, const std::string& picture,
    const std::optional<ShutterTimes>& shutter = std::nullopt);

}  // namespace microtrace
