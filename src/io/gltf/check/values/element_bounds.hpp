#pragma once
/// The least and greatest components of an accessor's elements.

#include "io/gltf/check/values/elements.hpp"

#include <array>
#include <cstddef>

namespace microtrace::io::gltf {

inline constexpr std::size_t kMaxComponents = 16;

struct ElementBounds {
  std::array<double, kMaxComponents> least{}, greatest{};
  bool all_finite = true;
};

[[nodiscard]] ElementBounds bounds_of(const Elements& elements);

/// Returns true if no number of float32 elements is infinite or NaN.
[[nodiscard]] bool all_finite(const Elements& elements);

}  // namespace microtrace::io::gltf
