#pragma once
/// Chooses the exposure of pictures.

#include <microtrace/camera.hpp>
#include <microtrace/export.hpp>
#include <microtrace/prepared_scene.hpp>
#include <microtrace/render.hpp>

namespace microtrace {

/// Returns the exposure in stops (Display::exposure) that is nearest to 0 and at which the visible
/// lit surfaces are neither blown out nor black: their 95th percentile is between 1/8 and 1.
/// Measures the brightest channel of each pixel in a small picture of the scene, weighted with
/// coverage. The result is a multiple of 1/10 and 0 if no surface is lit. It depends on the scene,
/// the camera, the shape of the picture and the integrator, environment and background in
/// `options`, not on samples, seed or crop. options.progress is called with 0,
/// and may cancel.
///
/// Throws the errors of render().
[[nodiscard]] MICROTRACE_EXPORT double automatic_exposure(const PreparedScene& scene,
                                                          const Camera& camera, ImageSize size,
                                                          const RenderOptions& options = {});

}  // namespace microtrace
