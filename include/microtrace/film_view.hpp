#pragma once
/// Whether a finished picture shows anything.

#include <microtrace/camera.hpp>
#include <microtrace/export.hpp>
#include <microtrace/film.hpp>
#include <microtrace/render.hpp>
#include <microtrace/scene.hpp>

namespace microtrace {

struct FilmView {
  bool is_empty = true;  ///< no pixel shows anything of the scene or its environment
  /// 8-bit pictures show more than three quarters of the pixels black that show something.
  bool is_dark = false;
  float brightest = 0;  ///< the greatest part of a color in black pixels, linear
};

/// Of the picture that render() made of the same; exposure and tone map are the film's. Where
/// background alone can't be told from what is black, the scene is asked what is at the pixels'
/// centers. Throws Error.
[[nodiscard]] MICROTRACE_EXPORT FilmView view_of(const Film& film, const Scene& scene,
                                                 const Camera& camera,
                                                 const RenderOptions& options);

}  // namespace microtrace
