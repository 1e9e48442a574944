#pragma once
/// Options for the light around the scene, what lies behind it, and how it is shown.

#include "cli/option_values.hpp"

#include <microtrace/environment.hpp>
#include <microtrace/error.hpp>
#include <microtrace/film.hpp>
#include <microtrace/memory.hpp>
#include <microtrace/scene.hpp>

#include <filesystem>
#include <optional>
#include <variant>
#include <vector>

namespace CLI {
class App;
}

namespace microtrace::cli {

/// Light of one colour, the studio, or a map's file.
using EnvironmentSource = std::variant<Vec3, Studio, std::filesystem::path>;

struct Surroundings {
  std::optional<EnvironmentSource> environment{};
  std::optional<double> rotation{};  ///< degrees
  std::optional<float> intensity{};
  std::optional<Background> background{};

  [[nodiscard]] bool is_transparent() const {
    return background && background->kind == Background::Kind::transparent;
  }
  [[nodiscard]] bool shows_environment() const {
    return background && background->kind == Background::Kind::environment;
  }
};

/// How 8-bit formats show light; what is not given is left to the integrator.
struct Exposure {
  std::optional<double> stops{};
  std::optional<ToneMap> tone_map{};
};

/// Adds the options, which are written to `surroundings` and `exposure` when the app parses.
void add_light_options(CLI::App& app, Surroundings& surroundings, Exposure& exposure);

/// Adds those that say how light is shown, alone.
void add_exposure_options(CLI::App& app, Exposure& exposure);

/// Changes how the film is shown, unless it shows numbers rather than light.
void expose(Film& film, const Exposure& exposure);

/// The environment that the options name, if they do; reads its file and adds to the warnings.
/// Throws Error.
[[nodiscard]] std::optional<Environment> load_environment(const Surroundings& surroundings,
                                                          std::vector<Diagnostic>& warnings,
                                                          MemoryBudget& memory);

/// Gives the scene that environment, if there is one, and all else that the options ask for; those
/// that speak of an environment where there is none mean the studio.
void surround(Scene& scene, const std::optional<Environment>& environment,
              const Surroundings& surroundings);

}  // namespace microtrace::cli
