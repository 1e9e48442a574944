#pragma once
/// Tables of kernels, one for each instruction set. Not to be included by the kernels' own
/// translation units.

#include "simd/instruction_set.hpp"

#include <vector>

namespace microtrace {

template <class Table>
struct KernelTables {
  const Table* portable;
  const Table* avx2;  ///< null on processors of another architecture, as is the next member
  const Table* avx512;

  [[nodiscard]] const Table* of(InstructionSet set) const {
    return set == InstructionSet::avx512 ? avx512 : set == InstructionSet::avx2 ? avx2 : portable;
  }
  /// The tables that this processor supports, fastest first.
  [[nodiscard]] std::vector<const Table*> available() const {
    std::vector<const Table*> result;
    for (const InstructionSet set : available_instruction_sets()) result.push_back(of(set));
    return result;
  }
  /// The table for best_instruction_set().
  [[nodiscard]] const Table& best() const { return *of(best_instruction_set()); }
};

/// The tables with these names, of which only the first exists on every architecture.
#if defined(__x86_64__)
#define MICROTRACE_KERNEL_TABLES(portable, avx2, avx512) \
  { &(portable), &(avx2), &(avx512) }
#else
#define MICROTRACE_KERNEL_TABLES(portable, avx2, avx512) \
  { &(portable), nullptr, nullptr }
#endif

}  // namespace microtrace
