#pragma once
/// Which instruction set the kernels of every part take. Not for the kernels' own translation
/// units.

#include <string_view>
#include <vector>

namespace microtrace {

/// Each has all that those before it have.
enum class InstructionSet { portable, avx2, avx512 };

/// As MICROTRACE_ISA has it: portable, avx2, avx512.
[[nodiscard]] std::string_view name_of(InstructionSet set);

/// Those that this processor runs and this program has kernels for, the fastest first.
[[nodiscard]] std::vector<InstructionSet> available_instruction_sets();

/// The first of them; or the one that the environment variable MICROTRACE_ISA names, portable where
/// this processor doesn't run that. Throws Error (usage) where it names none.
[[nodiscard]] InstructionSet best_instruction_set();

}  // namespace microtrace
