#pragma once
/// The nearest hit by its definition, and calls with each of the machine's kernels.

#include "accel/kernels/dispatch.hpp"
#include "exact/first_hit.hpp"

#include <microtrace/hit.hpp>
#include <microtrace/primitives.hpp>
#include <microtrace/ray.hpp>

#include <bit>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>

#include <gtest/gtest.h>

namespace microtrace {

/// Returns the nearest hit, computed only with exact arithmetic.
[[nodiscard]] inline std::optional<Hit> hit_by_definition(const Primitives& primitives,
                                                          const Ray& ray) {
  std::optional<exact::Root> nearest;
  std::optional<Hit> best;
  primitives.for_each([&](PrimitiveId id, const auto& shape) {
    const auto t = exact::first_hit(shape, ray);
    if (!t || (nearest && *t >= *nearest)) return;
    nearest = t;
    best = {.id = id, .t = exact::round_to_float(*t)};
  });
  return best;
}

/// Compares the bits of t.
[[nodiscard]] inline ::testing::AssertionResult same(const std::optional<Hit>& a,
                                                     const std::optional<Hit>& b) {
  const auto bits = [](float x) { return std::bit_cast<std::uint32_t>(x); };
  if (a.has_value() == b.has_value() && (!a || (a->id == b->id && bits(a->t) == bits(b->t))))
    return ::testing::AssertionSuccess();
  const auto show = [](const std::optional<Hit>& hit) {
    return hit ? std::to_string(hit->id) + " at " + std::to_string(hit->t) : std::string("none");
  };
  return ::testing::AssertionFailure() << show(a) << " is not " << show(b);
}

/// Calls f with each of the machine's kernels selected. Trees that f builds use the selected
/// kernels.
template <class F>
void with_each_kernel(const F& f) {
  for (const Kernels* kernels : kRayKernels.available()) {
    SCOPED_TRACE(kernels->name);
    setenv("MICROTRACE_ISA", kernels->name, 1);
    EXPECT_EQ(&kRayKernels.best(), kernels);
    f();
    unsetenv("MICROTRACE_ISA");
    if (testing::Test::HasFatalFailure()) return;
  }
}

}  // namespace microtrace
