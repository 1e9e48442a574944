#include "simd/instruction_set.hpp"

#include "base/text/printable.hpp"

#include <microtrace/error.hpp>

#include <algorithm>
#include <array>
#include <cstdlib>

namespace microtrace {

namespace {

constexpr std::array kSets = {InstructionSet::portable, InstructionSet::avx2,
                              InstructionSet::avx512};

}  // namespace

std::string_view name_of(InstructionSet set) {
  switch (set) {
    case InstructionSet::avx512:
      return "avx512";
    case InstructionSet::avx2:
      return "avx2";
    case InstructionSet::portable:
      break;
  }
  return "portable";
}

std::vector<InstructionSet> available_instruction_sets() {
  std::vector<InstructionSet> available;
#if defined(MICROTRACE_WITH_AVX)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw"))
    available.push_back(InstructionSet::avx512);
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
    available.push_back(InstructionSet::avx2);
#endif
  available.push_back(InstructionSet::portable);
  return available;
}

InstructionSet best_instruction_set() {
  const std::vector<InstructionSet> available = available_instruction_sets();
  const char* wanted = std::getenv("MICROTRACE_ISA");
  if (wanted == nullptr || *wanted == '\0') return available.front();
  const auto named = std::ranges::find(kSets, std::string_view(wanted), name_of);
  if (named == kSets.end()) {
    throw Error(
        ErrorKind::usage, "MICROTRACE_ISA",
        "names no instruction set: " + in_quotes(wanted) + "; known are portable, avx2 and avx512");
  }
  const bool is_there = std::ranges::find(available, *named) != available.end();
  return is_there ? *named : InstructionSet::portable;
}

}  // namespace microtrace
