#include "io/image/encode/eight_bits.hpp"

#include "scene/math/exponential.hpp"
#include "scene/math/srgb.hpp"
#include "scene/tone_map.hpp"

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

/// Encodes a row. shown(color) must return the color that encode(color, channel) expects.
template <class Show, class Encode>
void encode_all(const Film& film, std::uint32_t y, std::uint8_t* out, Show&& shown,
                Encode&& encode) {
  const std::span<const Vec3> colors = film.row(y);
  if (!film.has_alpha()) {
    for (const Vec3& pixel : colors) {
      const Vec3 color = shown(pixel);
      for (glm::length_t i = 0; i < 3; ++i) *out++ = encode(color, i);
    }
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
