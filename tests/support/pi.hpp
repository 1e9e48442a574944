#pragma once

#include <numbers>

namespace microtrace {

inline constexpr double kPi = std::numbers::pi;

}  // namespace microtrace
