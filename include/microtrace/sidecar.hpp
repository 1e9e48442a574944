#pragma once
/// A description of a picture as JSON text.

#include <microtrace/camera.hpp>
#include <microtrace/export.hpp>
#include <microtrace/film.hpp>
#include <microtrace/scene.hpp>

#include <string>

namespace microtrace {

/// The camera, the objects with the ids of Aov::id, and the materials; docs/outputs.md describes
/// the members. `picture` is the picture's name in the text. If the film has the channel
/// "id.instance", objects have the number and the bounding box of the pixels that show them.
[[nodiscard]] MICROTRACE_EXPORT std::string describe_picture(const Scene& scene,
                                                             const Camera& camera, const Film& film,
                                                             const std::string& picture);

}  // namespace microtrace
