#pragma once
/// Tables of kernels, one for each instruction set. The kernels' own translation units must not
/// include this header.

#include "simd/instruction_set.hpp"

#include <vector>

namespace microtrace {

template <class Table>
struct KernelTables {
  const Table* portable;
  const Table* avx2;  ///< null without MICROTRACE_WITH_AVX, like the next member
  const Table* avx512;

  [[nodiscard]] const Table* of(InstructionSet set) const {
    return set == InstructionSet::avx512 ? avx512 : set == InstructionSet::avx2 ? avx2 : portable;
  }
  /// Returns the tables for available_instruction_sets(), fastest first.
  [[nodiscard]] std::vector<const Table*> available() const {
    std::vector<const Table*> result;
    for (const InstructionSet set : available_instruction_sets()) result.push_back(of(set));
    return result;
  }
  /// Returns the table for best_instruction_set().
  [[nodiscard]] const Table& best() const { return *of(best_instruction_set()); }
};

/// Initializes KernelTables with the tables of these names, of which only the first exists without
/// MICROTRACE_WITH_AVX.
#if defined(MICROTRACE_WITH_AVX)
#define MICROTRACE_KERNEL_TABLES(portable, avx2, avx512) \
  { &(portable), &(avx2), &(avx512) }
#else
#define MICROTRACE_KERNEL_TABLES(portable, avx2, avx512) \
  { &(portable), nullptr, nullptr }
#endif

}  // namespace microtrace
