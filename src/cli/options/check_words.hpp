#pragma once
/// Finds mistakes in values of options that CLI11 accepts.

#include "cli/options/option.hpp"

#include <span>
#include <string>

namespace microtrace::cli {

/// Throws Error (usage) because the named option has an empty value.
[[noreturn]] void refuse_empty(const std::string& name);

/// Throws Error (usage) if a word gives a value to a switch, or an empty value to another option
/// that may omit it, or if an option follows in place of a value.
void check_words(Command command, std::span<char* const> words);

}  // namespace microtrace::cli
