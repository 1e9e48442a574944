#pragma once
#include <microtrace/film.hpp>
#include <microtrace/math.hpp>

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

}  // namespace microtrace
