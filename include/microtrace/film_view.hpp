#pragma once
/// Detects pictures that show nothing or are almost black.

#include <microtrace/camera.hpp>
#include <microtrace/export.hpp>
#include <microtrace/film.hpp>
#include <microtrace/prepared_scene.hpp>
#include <microtrace/render.hpp>

namespace microtrace {

struct FilmView {
  bool is_empty = true;  ///< no pixel shows any part of the scene or its environment
  /// True if, in 8-bit pictures, more than three quarters of the pixels that show something are
  /// black or almost black.
  bool is_dark = false;
  float brightest = 0;  ///< the greatest color component among the black pixels, linear
};

/// Examines a film that render() returned for the same arguments, with the exposure and tone map of
/// film.display. If colors alone don't show whether pixels have the background's color or show a
/// surface, traces rays through the pixel centers. Throws Error as render() does.
[[nodiscard]] MICROTRACE_EXPORT FilmView view_of(const Film& film, const PreparedScene& prepared,
                                                 const Camera& camera,
                                                 const RenderOptions& options);

}  // namespace microtrace
