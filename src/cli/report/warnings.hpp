#pragma once
/// Warnings on standard error.

#include "cli/arguments.hpp"

#include <microtrace/error.hpp>
#include <microtrace/film_view.hpp>
#include <microtrace/scene.hpp>

#include <cstddef>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace microtrace::cli {

/// Prints each warning once, and no warnings with --quiet. Violations of a format's rules that
/// don't prevent rendering are reported as warnings, or as errors with --validate.
class Warnings {
 public:
  /// If `collected` is not null, appends warnings to it instead of printing them.
  explicit Warnings(const Arguments& arguments, std::vector<Diagnostic>* collected = nullptr)
      : collected_(collected),
        is_strict_(arguments.strict),
        is_quiet_(arguments.quiet),
        is_validating_(arguments.validate) {}

  /// With --strict, throws the first warning as an Error.
  void report(const std::vector<Diagnostic>& warnings);

  /// Reports a warning about a picture in the same way. Of the warnings of one kind about the
  /// pictures of a sequence or data set, prints only the first.
  void report_picture(const std::optional<Diagnostic>& warning, std::string_view kind);

  /// Prints the result of --validate and returns the exit code.
  [[nodiscard]] int print_result(const std::string& scene) const;

 private:
  void print(const Diagnostic& warning) const;

  std::vector<Diagnostic>* collected_;
  bool is_strict_, is_quiet_, is_validating_;
  std::size_t errors_ = 0;
  std::set<std::string> printed_;
  std::set<std::string, std::less<>> kinds_of_pictures_;
};

/// Returns the warning for a picture in which no object is visible, or which is almost entirely
/// black.
[[nodiscard]] std::optional<Diagnostic> picture_warning(const FilmView& view,
                                                        const Arguments& arguments,
                                                        const Scene& scene);

/// Returns the warning for --ground without a height in a scene without a lowest point.
[[nodiscard]] std::optional<Diagnostic> ground_warning(const Arguments& arguments,
                                                       const Scene& scene);

/// Describes the scene's lights, such as "the built-in studio" or "2 lights of intensity 0, no
/// environment".
[[nodiscard]] std::string lights_text(const Scene& scene);

}  // namespace microtrace::cli
