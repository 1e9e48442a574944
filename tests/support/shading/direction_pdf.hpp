#pragma once
/// Checks that directions sampled by a BSDF have the pdf that the BSDF returns.

#include "support/shading/chi_square.hpp"

#include <microtrace/math.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <vector>

namespace microtrace {

/// Returns a direction in local coordinates with z up. Angles are in radians.
inline Vec3 direction(double theta, double phi = 0.3) {
  return Vec3(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
}

/// Divides the sphere into cells of equal extent in cos(theta) and phi. The pdf is integrated over
/// each cell at fine x fine points.
struct DirectionGrid {
  int rows, columns, fine, samples;
};

struct PdfTest {
  double mass;    ///< integral of the pdf
  double excess;  ///< chi_square_excess of the sample counts; rejected samples have their own cell
};

template <class Bsdf>
PdfTest test_pdf(const Bsdf& bsdf, const DirectionGrid& grid, std::mt19937& random) {
  constexpr double pi = std::numbers::pi;
  const auto& [rows, columns, fine, samples] = grid;
  std::uniform_real_distribution<float> u(0, 1);
  std::vector<double> counts(std::size_t(rows * columns + 1)), expected(counts.size());
  for (int i = 0; i < samples; ++i) {
    const Vec2 chances{u(random), u(random)};
    const auto s = bsdf.sample(chances, u(random));
    if (!s) {
      ++counts.back();
      continue;
    }
    double phi = std::atan2(s->wi.y, s->wi.x) / (2 * pi);
    phi -= std::floor(phi);
    const int row = std::clamp(int((s->wi.z + 1) / 2 * float(rows)), 0, rows - 1);
    ++counts[std::size_t(row * columns + std::min(int(phi * columns), columns - 1))];
  }
  double mass = 0;
  for (int cell = 0; cell < rows * columns; ++cell) {
    double sum = 0;
    for (int i = 0; i < fine; ++i) {
      for (int j = 0; j < fine; ++j) {
        const double z = 2 * (cell / columns + (i + 0.5) / fine) / rows - 1;
        const double phi = 2 * pi * (cell % columns + (j + 0.5) / fine) / columns;
        sum += bsdf.evaluate(direction(std::acos(z), phi)).pdf;
      }
    }
    const double part = sum / (fine * fine) * 4 * pi / (rows * columns);
    expected[std::size_t(cell)] = part * samples;
    mass += part;
  }
  expected.back() = std::max(1 - mass, 0.0) * samples;
  return {.mass = mass, .excess = chi_square_excess(counts, expected)};
}

}  // namespace microtrace
