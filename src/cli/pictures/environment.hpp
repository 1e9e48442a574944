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

/// Loads the environment of --env if the option is given. Appends warnings about the environment's
/// file to `warnings`. Throws Error.
[[nodiscard]] std::optional<Environment> load_environment(const EnvironmentOptions& options,
                                                          std::vector<Diagnostic>& warnings,
                                                          MemoryBudget& memory);

/// Replaces the scene's environment by `environment` if present, and applies the other options. If
/// the scene then has no environment, options about the environment add the built-in studio and
/// apply to it.
void apply_environment(Scene& scene, const std::optional<Environment>& environment,
                       const EnvironmentOptions& options);

/// Applies exposure and tone map unless the film contains AOV values instead of light.
void apply_display(Film& film, const DisplayOptions& options);

}  // namespace microtrace::cli
