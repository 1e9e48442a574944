#pragma once
/// How much rough glass loses where light is followed through one scattering among its facets.

#include "render/bsdf/ggx.hpp"
#include "render/bsdf/glass_albedo_table.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace microtrace::bsdf {

/// What it returns and lets through together of white light to z = cos(theta), in (0, 1]; `eta` is
/// the index of refraction below over that above, from 1/3 to 3 or taken to be.
inline float glass_albedo(float eta, float roughness, float z) {
  struct Place {
    std::size_t first;
    float share;
  };
  const auto place = [](float s, int steps) {
    const float step = std::clamp(s, 0.0F, 1.0F) * static_cast<float>(steps - 1);
    const int first = std::min(static_cast<int>(step), steps - 2);
    return Place{static_cast<std::size_t>(first), step - static_cast<float>(first)};
  };
  const auto mixed = [](float a, float b, float share) { return a + share * (b - a); };
  const float alpha = Ggx(roughness).alpha();
  const Place index = place((eta - 1) / (eta + 1) + 0.5F, kGlassIndexSteps);
  const Place row = place(roughness, kGlassRoughnessSteps);
  const Place angle = place(z * (1 + alpha) / (z + alpha), kGlassAngleSteps);
  const auto of_row = [&](std::size_t i, std::size_t j) {
    const auto& values = kGlassAlbedo[i][j];
    return mixed(values[angle.first], values[angle.first + 1], angle.share);
  };
  const auto of_index = [&](std::size_t i) {
    return mixed(of_row(i, row.first), of_row(i, row.first + 1), row.share);
  };
  return mixed(of_index(index.first), of_index(index.first + 1), index.share);
}

}  // namespace microtrace::bsdf
