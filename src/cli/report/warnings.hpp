#pragma once
/// Warnings on standard error.

#include "cli/arguments.hpp"

#include <microtrace/error.hpp>
#include <microtrace/film_view.hpp>
#include <microtrace/scene.hpp>

#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace microtrace::cli {

/// Prints each warning once, and none with --quiet. Violations of a format's rules that don't
/// prevent rendering are warnings, but errors with --validate.
class Warnings {
 public:
  explicit Warnings(const Arguments& arguments)
      : is_strict_(arguments.strict),
        is_quiet_(arguments.quiet),
        is_validating_(arguments.validate) {}

  /// With --strict throws the first as an Error.
  void report(const std::vector<Diagnostic>& warnings);

  /// The same for a warning about a picture; only the first one of a sequence is printed.
  void report_picture(const std::optional<Diagnostic>& warning);

  /// Prints the result of --validate and returns the exit code.
  [[nodiscard]] int print_result(const std::string& scene) const;

 private:
  void print(const Diagnostic& warning) const;

  bool is_strict_, is_quiet_, is_validating_, has_reported_picture_ = false;
  std::size_t errors_ = 0;
  std::set<std::string> printed_;
};

/// The warning about a picture in which nothing of the scene is visible, or nearly all is black.
[[nodiscard]] std::optional<Diagnostic> picture_warning(const FilmView& view,
                                                        const Arguments& arguments,
                                                        const Scene& scene);

/// "the built-in studio", "2 lights of intensity 0, no environment"
[[nodiscard]] std::string lights_text(const Scene& scene);

}  // namespace microtrace::cli
