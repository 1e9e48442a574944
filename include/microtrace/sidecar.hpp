#pragma once
/// What a picture shows, in words and numbers, as a JSON text.

#include <microtrace/camera.hpp>
#include <microtrace/export.hpp>
#include <microtrace/film.hpp>
#include <microtrace/scene.hpp>

#include <string>

namespace microtrace {

/// The camera, the objects with the ids of Aov::id, and the materials; docs/outputs.md tells the
/// members. `picture` is the name that the text gives the picture. Where the film has the channel
/// "id.instance", objects have the number and the box of the pixels in which they are seen.
[[nodiscard]] MICROTRACE_EXPORT std::string describe_picture(const Scene& scene,
                                                             const Camera& camera, const Film& film,
                                                             const std::string& picture);

}  // namespace microtrace
