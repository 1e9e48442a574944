#include "io/image/encode/eight_bits.hpp"

#include "base/runs.hpp"
#include "scene/math/exponential.hpp"
#include "scene/math/srgb.hpp"
#include "scene/tone_map.hpp"

#include <algorithm>
#include <array>
#include <span>

namespace microtrace::io {
namespace {

/// Returns round(255 v), where v is first clamped to [0, 1]. Returns 0 for NaN.
std::uint8_t encode_linear(float v) {
  if (!(v > 0)) return 0;
  // This rounds wrongly only if the product is the number before 0.5.
  // NOLINTNEXTLINE(bugprone-incorrect-roundings)
  return v >= 1 ? 255 : static_cast<std::uint8_t>(v * 255 + 0.5F);
}

/// Stores a pixel `count` times; returns the end.
std::uint8_t* repeat(const std::array<std::uint8_t, 3>& code, std::size_t count,
                     std::uint8_t* out) {
  constexpr std::size_t kPixels = 16;
  if (count >= kPixels) {
    std::array<std::uint8_t, 3 * kPixels> pixels;
    for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = code[i % 3];
    for (; count >= kPixels; count -= kPixels) out = std::ranges::copy(pixels, out).out;
  }
  for (; count > 0; --count) out = std::ranges::copy(code, out).out;
  return out;
}

/// Encodes a row. shown(color) must return the color that encode(color, channel) expects.
template <class Show, class Encode>
void encode_all(const Film& film, std::uint32_t y, std::uint8_t* out, Show&& shown,
                Encode&& encode) {
  const std::span<const Vec3> colors = film.row(y);
  if (!film.has_alpha()) {
    // Neighboring pixels of pictures without lighting often have the same color.
    for_each_run(colors, [&](const Vec3& pixel, std::size_t count) {
      const Vec3 color = shown(pixel);
      const std::array<std::uint8_t, 3> code{encode(color, 0), encode(color, 1), encode(color, 2)};
      out = repeat(code, count, out);
    });
    return;
  }
  const std::span<const float> alphas = film.alpha_row(y);
  for (std::size_t x = 0; x < colors.size(); ++x) {
    const float alpha = alphas[x];
    const Vec3 color = alpha > 0 ? shown(colors[x] / alpha) : Vec3(0);
    for (glm::length_t i = 0; i < 3; ++i) *out++ = alpha > 0 ? encode(color, i) : std::uint8_t{0};
    *out++ = encode_linear(alpha);
  }
}

}  // namespace

void encode_row(const Film& film, std::uint32_t y, std::uint8_t* out) {
  const auto itself = [](const Vec3& color) { return color; };
  const auto srgb = [](const Vec3& color, glm::length_t i) { return encode_srgb(color[i]); };
  const Display& display = film.display;
  if (!display.srgb) {
    encode_all(film, y, out, itself, [&](const Vec3& color, glm::length_t i) {
      return encode_linear(display.scale[i] * color[i] + display.offset[i]);
    });
  } else if (display.exposure == 0 && display.tone_map == ToneMap::none) {
    encode_all(film, y, out, itself, srgb);
  } else {
    const auto factor = static_cast<float>(power_of_two(display.exposure));
    const auto show = [&](const Vec3& color) {
      return tone_mapped(factor * color, display.tone_map);
    };
    encode_all(film, y, out, show, srgb);
  }
}

}  // namespace microtrace::io
