#pragma once
#include <cstdint>

#include <CLI/Error.hpp>
#include <CLI/Validators.hpp>

namespace microtrace::cli {

/// For options whose value is a whole number: decimal digits alone, from `least` to `most`. CLI11
/// on its own takes 010 for eight, and 0x10 for sixteen.
[[nodiscard]] CLI::Validator whole_number_between(std::uint32_t least, std::uint32_t most);

}  // namespace microtrace::cli
