#pragma once
/// Applies the options about the environment, the background and the display.

#include "cli/arguments.hpp"

#include <microtrace/environment.hpp>
#include <microtrace/error.hpp>
#include <microtrace/film.hpp>
#include <microtrace/memory.hpp>
#include <microtrace/scene.hpp>

#include <optional>
#include <vector>

namespace microtrace::cli {

/// Loads the environment of --env, if it is given: reads its file and adds to the warnings. Throws
/// Error.
[[nodiscard]] std::optional<Environment> load_environment(const EnvironmentOptions& options,
                                                          std::vector<Diagnostic>& warnings,
                                                          MemoryBudget& memory);

/// Replaces the scene's environment if one is given, and applies the other options. Options about
/// the environment apply to the studio if the scene has no environment.
void apply_environment(Scene& scene, const std::optional<Environment>& environment,
                       const EnvironmentOptions& options);

/// Applies exposure and tone map, unless the film holds AOV values instead of light.
void apply_display(Film& film, const DisplayOptions& options);

}  // namespace microtrace::cli
