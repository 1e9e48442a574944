#pragma once
/// The numbers of cases and the random seeds of long tests.

#include "support/cases/adversarial_rays.hpp"

#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <string>

namespace microtrace {

/// Returns the number in an environment variable, or `fallback` if the variable is not set.
[[nodiscard]] inline std::uint64_t from_environment(const char* variable, std::uint64_t fallback) {
  const char* text = std::getenv(variable);
  return text == nullptr ? fallback : std::stoull(text);
}

namespace oracle {

/// Returns the number of cases of one test: a fraction of MICROTRACE_ORACLE_CASES, which is 1000000
/// by default.
[[nodiscard]] inline int case_count(double share) {
  return static_cast<int>(
      share * static_cast<double>(from_environment("MICROTRACE_ORACLE_CASES", 1'000'000)));
}

/// Returns the random generator of one test, seeded by MICROTRACE_ORACLE_SEED and the test's
/// number. Prints the seed.
[[nodiscard]] inline adversarial::Random announced_random(std::uint64_t test) {
  const std::uint64_t seed = from_environment("MICROTRACE_ORACLE_SEED", 1);
  std::cout << "MICROTRACE_ORACLE_SEED=" << seed << '\n';
  return adversarial::Random(seed * 1000 + test);
}

/// Prints the numbers of compared rays and hits.
inline void announce(int rays, int hits) {
  std::cout << rays << " rays agree, " << hits << " of them hit\n";
}

}  // namespace oracle

namespace traversal {

// Sanitizers make these tests about ten times slower.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr std::uint64_t kUsualRays = 100'000;
#else
inline constexpr std::uint64_t kUsualRays = 1'000'000;
#endif

/// Returns the number of rays of one test: a fraction of MICROTRACE_TRAVERSAL_RAYS. The variable's
/// default is 1000000, or a tenth of this in builds with sanitizers.
[[nodiscard]] inline std::size_t ray_count(double share) {
  return static_cast<std::size_t>(
      share * static_cast<double>(from_environment("MICROTRACE_TRAVERSAL_RAYS", kUsualRays)));
}

/// Returns the random generator of one test, seeded by MICROTRACE_TRAVERSAL_SEED and the test's
/// number. Prints the seed.
[[nodiscard]] inline adversarial::Random announced_random(std::uint64_t test) {
  const std::uint64_t seed = from_environment("MICROTRACE_TRAVERSAL_SEED", 1);
  std::cout << "MICROTRACE_TRAVERSAL_SEED=" << seed << '\n';
  return adversarial::Random(seed * 1000 + test);
}

}  // namespace traversal
}  // namespace microtrace
