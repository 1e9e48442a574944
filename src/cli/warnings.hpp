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

/// Says each warning once, and none where the arguments ask for quiet. Broken rules that a picture
/// survives are warnings to those who draw it, errors to those who validate.
class Warnings {
 public:
  explicit Warnings(const Arguments& arguments)
      : is_strict_(arguments.strict),
        is_quiet_(arguments.quiet),
        is_validating_(arguments.validate) {}

  /// Under --strict a scene with warnings is refused: throws Error.
  void report(const std::vector<Diagnostic>& warnings);

  /// The same of what a picture shows, of the first of several with something to say.
  void report_picture(const std::optional<Diagnostic>& warning);

  /// Prints the verdict of --validate, and returns the exit code.
  [[nodiscard]] int print_verdict(const std::string& scene) const;

 private:
  void tell(const Diagnostic& warning) const;

  bool is_strict_, is_quiet_, is_validating_, has_told_of_picture_ = false;
  std::size_t errors_ = 0;
  std::set<std::string> told_;
};

/// What to say of a picture with light or of colors that shows nothing, or next to nothing.
[[nodiscard]] std::optional<Diagnostic> warning_of(const FilmView& view, const Arguments& arguments,
                                                   const Scene& scene);

/// "the built-in studio", "2 lights, all of intensity 0, and no environment".
[[nodiscard]] std::string light_of(const Scene& scene);

}  // namespace microtrace::cli
