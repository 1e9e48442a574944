#include "cli/pictures/environment.hpp"

#include "scene/math/trigonometry.hpp"

#include <microtrace/io.hpp>

#include <iterator>

namespace microtrace::cli {

std::optional<Environment> load_environment(const EnvironmentOptions& options,
                                            std::vector<Diagnostic>& warnings,
                                            MemoryBudget& memory) {
  if (!options.source) return std::nullopt;
  Environment environment;
  if (const auto* file = std::get_if<std::filesystem::path>(&*options.source)) {
    LoadedRadianceMap loaded = load_radiance_map(*file, &memory);
    std::move(loaded.warnings.begin(), loaded.warnings.end(), std::back_inserter(warnings));
    environment.content = std::move(loaded.map);
  } else if (const auto* radiance = std::get_if<Vec3>(&*options.source)) {
    environment.content = *radiance;
  } else {
    environment.content = Studio{};
  }
  return environment;
}

void apply_environment(Scene& scene, const std::optional<Environment>& environment,
                       const EnvironmentOptions& options) {
  const bool is_background = options.shows_environment();
  if (environment) scene.environment = environment;
  if (!scene.environment && (is_background || options.rotation || options.intensity))
    scene.environment = Environment{.content = Studio{}};
  if (options.rotation) scene.environment->rotation = radians_from_degrees(*options.rotation);
  if (options.intensity) scene.environment->intensity = *options.intensity;
  if (!options.background) return;
  if (scene.environment) scene.environment->is_background = is_background;
  scene.background = options.background->color;
}

void apply_display(Film& film, const DisplayOptions& options) {
  if (!film.display.srgb) return;
  film.display.exposure = options.exposure.value_or(film.display.exposure);
  film.display.tone_map = options.tone_map.value_or(film.display.tone_map);
}

}  // namespace microtrace::cli
