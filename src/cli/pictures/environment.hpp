#pragma once
/// The environment, background and display that the command line asks for.

#include "cli/arguments.hpp"

#include <microtrace/environment.hpp>
#include <microtrace/error.hpp>
#include <microtrace/film.hpp>
#include <microtrace/memory.hpp>
#include <microtrace/scene.hpp>

#include <optional>
#include <vector>

namespace microtrace::cli {

/// The environment of --env, if it is given; reads its file and adds to the warnings. Throws Error.
[[nodiscard]] std::optional<Environment> load_environment(const EnvironmentOptions& options,
                                                          std::vector<Diagnostic>& warnings,
                                                          MemoryBudget& memory);

/// Replaces the scene's environment, if one is given, and applies the other options. Options about
/// an environment that the scene doesn't have apply to the studio.
void apply_environment(Scene& scene, const std::optional<Environment>& environment,
                       const EnvironmentOptions& options);

/// Applies exposure and tone map, unless the film shows numbers rather than light.
void apply_display(Film& film, const DisplayOptions& options);

}  // namespace microtrace::cli
