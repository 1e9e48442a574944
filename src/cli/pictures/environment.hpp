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

/// Gives the scene that environment, if there is one, and applies the other options. Where the
/// options need an environment and there is none, it is the studio.
void apply_environment(Scene& scene, const std::optional<Environment>& environment,
                       const EnvironmentOptions& options);

/// Changes how the film is shown, unless it shows numbers rather than light.
void apply_display(Film& film, const DisplayOptions& options);

}  // namespace microtrace::cli
