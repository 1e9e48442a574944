#include "cli/arguments_light.hpp"

#include "scene/trigonometry.hpp"

#include <microtrace/io.hpp>

#include <iterator>
#include <string>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

namespace microtrace::cli {
namespace {

EnvironmentSource parse_environment(const std::string& text) {
  if (text == "studio") return Studio{};
  if (const auto radiance = parse_radiance(text)) return *radiance;
  if (!text.empty() && text[0] != '#') return std::filesystem::path(text);
  throw CLI::ValidationError("--env",
                             "wants studio, #rrggbb (sRGB), three numbers from 0 on (linear "
                             "light) as 0.2,0.4,1, or a file, not " +
                                 text);
}

}  // namespace

void add_light_options(CLI::App& app, Surroundings& surroundings) {
  app.add_option_function<std::string>(
         "--env",
         [&](const std::string& text) { surroundings.environment = parse_environment(text); },
         "light from all around: studio, #rrggbb in sRGB, r,g,b in linear light, or the file of a "
         "latitude-longitude map (.hdr, .exr, ...) [as the scene says]")
      ->type_name("LIGHT");
  app.add_option_function<std::string>(
         "--env-rotation",
         [&](const std::string& text) {
           surroundings.rotation = parse_number("--env-rotation", text);
         },
         "of the environment about the vertical axis, in degrees, anticlockwise as seen from above "
         "[0]")
      ->type_name("DEGREES");
  app.add_option_function<std::string>(
         "--env-intensity",
         [&](const std::string& text) {
           const double intensity = parse_number("--env-intensity", text);
           if (!(intensity >= 0 && intensity <= kMaxRadiance))
             throw CLI::ValidationError("--env-intensity", "must be from 0 to 1e9, is " + text);
           surroundings.intensity = static_cast<float>(intensity);
         },
         "multiplies the environment's light [1]")
      ->type_name("X");
  app.add_option_function<std::string>(
         "--background",
         [&](const std::string& text) { surroundings.background = parse_background(text); },
         "what is seen behind all objects: #rrggbb in sRGB, r,g,b in linear light from 0 to 1, "
         "env: the environment, or transparent: an alpha channel [as the scene says, or black]")
      ->type_name("COLOUR");
}

std::optional<Environment> load_environment(const Surroundings& surroundings,
                                            std::vector<Diagnostic>& warnings) {
  if (!surroundings.environment) return std::nullopt;
  Environment environment;
  const EnvironmentSource& source = *surroundings.environment;
  if (const auto* file = std::get_if<std::filesystem::path>(&source)) {
    LoadedRadianceMap loaded = load_radiance_map(*file);
    std::move(loaded.warnings.begin(), loaded.warnings.end(), std::back_inserter(warnings));
    environment.content = std::move(loaded.map);
  } else if (const auto* radiance = std::get_if<Vec3>(&source)) {
    environment.content = *radiance;
  } else {
    environment.content = Studio{};
  }
  return environment;
}

void surround(Scene& scene, const std::optional<Environment>& environment,
              const Surroundings& surroundings) {
  if (environment) scene.environment = environment;
  const auto require_environment = [&](const std::string& option) {
    if (!scene.environment)
      throw Error(ErrorKind::usage, "",
                  option + ": the scene has no environment; name one by --env");
  };
  if (surroundings.rotation) {
    require_environment("--env-rotation");
    scene.environment->rotation = radians_from_degrees(*surroundings.rotation);
  }
  if (surroundings.intensity) {
    require_environment("--env-intensity");
    scene.environment->intensity = *surroundings.intensity;
  }
  if (!surroundings.background) return;
  const bool is_environment = surroundings.background->kind == Background::Kind::environment;
  if (is_environment) require_environment("--background env");
  if (scene.environment) scene.environment->is_background = is_environment;
  scene.background = surroundings.background->color;
}

}  // namespace microtrace::cli
