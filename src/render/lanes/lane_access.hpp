#pragma once
/// Copies lanes, and loads and stores the values of single paths in them. The kernels' own
/// translation units must not include this header.

#include "render/lanes/shading_kernels.hpp"

#include <microtrace/math.hpp>

#include <cstring>

namespace microtrace {

/// Copies an array of lanes, or several ones.
template <class Lanes>
void copy(Lanes& to, const Lanes& from) {
  std::memcpy(&to, &from, sizeof to);
}

template <int width>
void put(float (&lanes)[3][width], int lane, const Vec3& v) {
  lanes[0][lane] = v.x;
  lanes[1][lane] = v.y;
  lanes[2][lane] = v.z;
}

template <int width>
[[nodiscard]] Vec3 got(const float (&lanes)[3][width], int lane) {
  return {lanes[0][lane], lanes[1][lane], lanes[2][lane]};
}

}  // namespace microtrace
