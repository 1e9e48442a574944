#pragma once
/// Formats explanations of rays for people.

#include <microtrace/explain.hpp>

#include <string>

namespace microtrace::cli {

/// Returns the explanation as lines of text, which may be printed on a terminal.
[[nodiscard]] std::string explanation_text(const Explanation& explanation);

}  // namespace microtrace::cli
