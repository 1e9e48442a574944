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

ToneMap parse_tone_map(const std::string& text) {
  if (const auto map = tone_map_named(text)) return *map;
  std::string names;
  for (const ToneMap map : kToneMaps) names.append(names.empty() ? "" : ", ").append(name_of(map));
  throw CLI::ValidationError("--tonemap", "wants " + names + ", not " + text);
}

}  // namespace

void add_light_options(CLI::App& app, Surroundings& surroundings, Exposure& exposure) {
  app.add_option_function<std::string>(
         "--env",
         [&](const std::string& text) { surroundings.environment = parse_environment(text); },
         "light from all around: studio, #rrggbb in sRGB, r,g,b in linear light, or the file of a "
         "latitude-longitude map (.hdr, .exr, ...) [as the scene says; the studio if it has no "
         "light]")
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
  add_exposure_options(app, exposure);
}

void add_exposure_options(CLI::App& app, Exposure& exposure) {
  app.add_option_function<std::string>(
         "--exposure",
         [&](const std::string& text) {
           const double stops = parse_number("--exposure", text);
           if (!(stops >= -64 && stops <= 64))
             throw CLI::ValidationError("--exposure", "must be from -64 to 64, is " + text);
           exposure.stops = stops;
         },
         "in stops: 8-bit pictures show light times 2^EV [0]")
      ->type_name("EV");
  app.add_option_function<std::string>(
         "--tonemap", [&](const std::string& text) { exposure.tone_map = parse_tone_map(text); },
         "how 8-bit pictures show bright light: none, khronos-pbr-neutral, aces or agx "
         "[khronos-pbr-neutral for path, else none]")
      ->type_name("NAME");
}

void expose(Film& film, const Exposure& exposure) {
  if (!film.display.srgb) return;
  film.display.exposure = exposure.stops.value_or(film.display.exposure);
  film.display.tone_map = exposure.tone_map.value_or(film.display.tone_map);
}

std::optional<Environment> load_environment(const Surroundings& surroundings,
                                            std::vector<Diagnostic>& warnings,
                                            MemoryBudget& memory) {
  if (!surroundings.environment) return std::nullopt;
  Environment environment;
  const EnvironmentSource& source = *surroundings.environment;
  if (const auto* file = std::get_if<std::filesystem::path>(&source)) {
    LoadedRadianceMap loaded = load_radiance_map(*file, &memory);
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
  const std::optional<Background>& background = surroundings.background;
  const bool is_seen = surroundings.shows_environment();
  if (environment) scene.environment = environment;
  if (!scene.environment && (is_seen || surroundings.rotation || surroundings.intensity))
    scene.environment = Environment{.content = Studio{}};
  if (surroundings.rotation)
    scene.environment->rotation = radians_from_degrees(*surroundings.rotation);
  if (surroundings.intensity) scene.environment->intensity = *surroundings.intensity;
  if (!background) return;
  if (scene.environment) scene.environment->is_background = is_seen;
  scene.background = background->color;
}

}  // namespace microtrace::cli
