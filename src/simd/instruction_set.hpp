#pragma once
/// The instruction set for the kernels of all parts. Not to be included by the kernels' own
/// translation units.

#include <string_view>
#include <vector>

namespace microtrace {

/// Each value includes the instructions of the previous ones.
enum class InstructionSet { portable, avx2, avx512 };

/// The name used by MICROTRACE_ISA: portable, avx2, avx512.
[[nodiscard]] std::string_view name_of(InstructionSet set);

/// The instruction sets that this processor supports and this program has kernels for, fastest
/// first.
[[nodiscard]] std::vector<InstructionSet> available_instruction_sets();

/// The fastest available instruction set, or the one that the environment variable MICROTRACE_ISA
/// names. If the processor doesn't support the named set, portable. Throws Error (usage) if the
/// variable has an unknown value.
[[nodiscard]] InstructionSet best_instruction_set();

}  // namespace microtrace
