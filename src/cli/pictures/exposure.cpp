#include "cli/pictures/exposure.hpp"

#include "base/system/processors.hpp"
#include "cli/camera.hpp"
#include "cli/pictures/environment.hpp"

#include <microtrace/defaults.hpp>
#include <microtrace/exposure.hpp>

#include <memory>
#include <string>
#include <utility>

namespace microtrace::cli {

void refuse_automatic_exposure(const DisplayOptions& display, const char* command) {
  if (display.automatic != AutomaticExposure::always) return;
  refuse_usage("--exposure: " + std::string(command) + " doesn't support auto; give a number");
}

bool is_exposure_automatic(const DisplayOptions& display, const Scene& scene) {
  if (display.exposure) return false;
  return display.automatic == AutomaticExposure::always ||
         (display.automatic == AutomaticExposure::for_lights && !scene.lights.empty());
}

DisplayOptions with_exposure(const DisplayOptions& display, const PreparedScene& scene,
                             const Camera& camera, ImageSize size, const RenderOptions& options) {
  DisplayOptions result = display;
  if (is_exposure_automatic(display, scene.scene()))
    result.exposure = automatic_exposure(scene, camera, size, options);
  return result;
}

DisplayOptions with_exposure(const Arguments& arguments, const PreparedScene& scene,
                             const Camera& camera, ImageSize size) {
  const std::unique_ptr<Integrator> integrator = make_integrator(*arguments.integrator);
  return with_exposure(arguments.display, scene, camera, size,
                       {.threads = thread_count(arguments.threads),
                        .integrator = integrator.get(),
                        .memory = arguments.load.memory});
}

DisplayOptions with_exposure_of_frames(SceneFile& file, const Arguments& arguments,
                                       const std::optional<Environment>& environment,
                                       const std::optional<PerspectiveCamera>& framing) {
  if (arguments.display.exposure || arguments.display.automatic == AutomaticExposure::never)
    return arguments.display;  // without loading the scene
  Scene scene = file.at(0.0).scene;
  if (!is_exposure_automatic(arguments.display, scene)) return arguments.display;
  apply_environment(scene, environment, arguments.environment);
  const ImageSize size = arguments.size.value_or(scene.size);
  const Camera camera = framing ? Camera(in_coordinates_of(scene, *framing))
                                : choose_camera(scene, arguments.camera, size);
  const unsigned threads = thread_count(arguments.threads);
  const PreparedScene prepared(std::move(scene),
                               {.threads = threads, .memory = arguments.load.memory});
  return with_exposure(arguments, prepared, camera, size);
}

}  // namespace microtrace::cli
