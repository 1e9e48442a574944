#pragma once
/// Converts the options that a page sends to the arguments of render().

#include "cli/arguments.hpp"
#include "cli/view/scene_source.hpp"

#include <microtrace/camera.hpp>
#include <microtrace/denoise.hpp>
#include <microtrace/error.hpp>
#include <microtrace/film.hpp>
#include <microtrace/integrator.hpp>
#include <microtrace/render.hpp>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace microtrace::cli {

/// Parses options of `microtrace view`, one word per line. Throws Error (usage).
[[nodiscard]] Arguments parse_picture(const Arguments& program, const std::string& lines);

/// A picture of the scene, ready to be rendered. It is the picture that the program draws with the
/// same options.
struct PictureJob {
  std::shared_ptr<const ShownScene> scene;
  Arguments arguments;  ///< with the defaults of the scene's format
  /// The given options that the integrator can't apply, as omit_inapplicable() returns them. The
  /// page keeps them for pictures of other integrators.
  std::vector<std::string> omitted;
  std::optional<Diagnostic> warning;  ///< about the options
  ImageSize size;
  Camera camera;  ///< in scene coordinates
  std::unique_ptr<Integrator> integrator;
  RenderOptions options;  ///< refers to the integrator
  std::optional<Denoiser> denoiser;
  Display display;  ///< of films that were rendered in passes
};

/// Loads the scene if necessary. Throws Error.
[[nodiscard]] PictureJob make_job(SceneSource& source, Arguments arguments);

/// Renders the picture. Throws Error.
[[nodiscard]] Film render(const PictureJob& job);

/// Returns true if the page shows the variance of the samples instead of colors.
[[nodiscard]] bool shows_variance(const PictureJob& job);

/// Returns a gray picture of the standard deviations of the pixels' means; the greatest 2 %
/// are white. The variances are in the first channel of `film`.
[[nodiscard]] Film deviation_picture(const Film& film);

}  // namespace microtrace::cli
