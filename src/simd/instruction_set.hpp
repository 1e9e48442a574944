#pragma once
/// The instruction set that kernels use. The kernels' own translation units must not include this
/// header.

#include <string_view>
#include <vector>

namespace microtrace {

/// The instruction sets, each of which includes the previous ones.
enum class InstructionSet { portable, avx2, avx512 };

/// Returns the name used by MICROTRACE_ISA: portable, avx2 or avx512.
[[nodiscard]] std::string_view name_of(InstructionSet set);

/// Returns the instruction sets that this processor supports and for which this program has
/// kernels, fastest first.
[[nodiscard]] std::vector<InstructionSet> available_instruction_sets();

/// Returns the instruction set that the environment variable MICROTRACE_ISA names, or portable if
/// the processor doesn't support that set. If the variable is not set, returns the fastest
/// available set. Throws Error (usage) if the variable has an unknown value.
[[nodiscard]] InstructionSet best_instruction_set();

}  // namespace microtrace
