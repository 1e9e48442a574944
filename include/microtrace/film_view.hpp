#pragma once
/// Detects pictures that show nothing or are almost black.

#include <microtrace/camera.hpp>
#include <microtrace/export.hpp>
#include <microtrace/film.hpp>
#include <microtrace/render.hpp>
#include <microtrace/scene.hpp>

namespace microtrace {

struct FilmView {
  bool is_empty = true;  ///< no pixel shows any part of the scene or its environment
  /// More than three quarters of the pixels that show something are black in 8-bit pictures.
  bool is_dark = false;
  float brightest = 0;  ///< the greatest color component of black pixels, linear
};

/// Examines a picture made by render() with the same arguments; exposure and tone map are the
/// film's. Where the background can't be distinguished from black, rays are traced through the
/// pixel centers. Throws Error.
[[nodiscard]] MICROTRACE_EXPORT FilmView view_of(const Film& film, const Scene& scene,
                                                 const Camera& camera,
                                                 const RenderOptions& options);

}  // namespace microtrace
