// Checks that the compiler rounds to float32 where the source says so. GCC 12.2 with
// -ftree-slp-vectorize doesn't in each(), which made the normals of placed meshes depend on the
// compiler.

#include <array>
#include <cstddef>

#include <gtest/gtest.h>

namespace {

template <std::size_t n>
[[gnu::noinline]] void each(double* __restrict to, const double* __restrict from) {
  for (std::size_t i = 0; i < n; ++i) to[i] = static_cast<double>(static_cast<float>(from[i]));
}

template <std::size_t n>
void expect_rounded() {
  std::array<double, n> from{}, to{};
  for (std::size_t i = 0; i < n; ++i) from[i] = 0.1 * static_cast<double>(i + 1);
  each<n>(to.data(), from.data());
  for (std::size_t i = 0; i < n; ++i) {
    const volatile auto rounded = static_cast<float>(from[i]);
    EXPECT_EQ(to[i], static_cast<double>(rounded)) << n << " numbers, number " << i;
  }
}

TEST(Conversions, RoundToFloat32) {
  expect_rounded<1>();
  expect_rounded<2>();
  expect_rounded<3>();
  expect_rounded<4>();
  expect_rounded<6>();
  expect_rounded<8>();
}

}  // namespace
