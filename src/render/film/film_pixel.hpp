#pragma once
#include <microtrace/film.hpp>
#include <microtrace/math.hpp>

#include <algorithm>
#include <cstdint>

namespace microtrace {

/// Sets a pixel of the film to a premultiplied color. If the film has no alpha, first composites
/// the color over the background.
inline void set_pixel(Film& film, std::uint32_t x, std::uint32_t y, const Vec3& color, float alpha,
                      const Vec3& background) {
  if (film.has_alpha()) {
    film.at(x, y) = color;
    film.alpha_at(x, y) = alpha;
  } else {
    film.at(x, y) = color + (1 - alpha) * background;
  }
}

/// Sets `count` pixels from (x, y) on, of one row, to the same color.
inline void set_pixels(Film& film, std::uint32_t x, std::uint32_t y, std::uint32_t count,
                       const Vec3& color, float alpha, const Vec3& background) {
  set_pixel(film, x, y, color, alpha, background);
  Vec3* const first = &film.at(x, y);
  std::fill(first + 1, first + count, *first);
  if (film.has_alpha()) std::fill_n(&film.alpha_at(x, y), count, alpha);
}

}  // namespace microtrace
