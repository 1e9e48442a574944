#include "base/system/float_environment.hpp"
#include "render/aovs/sights.hpp"

#include <microtrace/aov.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include <glm/common.hpp>

namespace microtrace {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// A color that 8 bits represent exactly and that is never dark. Different ids have different
/// colors, except that these repeat after 192^3 ids. Consecutive ids have very different colors.
Vec3 color_of_id(std::uint32_t id) {
  constexpr std::uint64_t kDarkest = 64, kValues = 256 - kDarkest;
  // Near the golden ratio times kValues^3, and without common factors with it.
  constexpr std::uint64_t kStep = 4374377;
  std::uint64_t rest = id * kStep % (kValues * kValues * kValues);
  Vec3 color;
  for (glm::length_t i = 0; i < 3; ++i, rest /= kValues)
    color[i] = static_cast<float>(kDarkest + rest % kValues) / 255;
  return color;
}

template <class F>
void for_each_pixel(const Film& film, F&& f) {
  for (std::uint32_t y = 0; y < film.size().height; ++y) {
    for (const Vec3& value : film.row(y)) f(value);
  }
}

/// Maps the nearest value to 1 and the farthest to 0.2.
Display of_lengths(const Film& film) {
  float nearest = kInfinity, farthest = -kInfinity;
  for_each_pixel(film, [&](const Vec3& value) {
    if (!std::isfinite(value.x)) return;
    nearest = std::min(nearest, value.x);
    farthest = std::max(farthest, value.x);
  });
  const float range = farthest - nearest;
  const float scale = range > 0 && std::isfinite(range) ? -0.8F / range : 0;
  const float offset = scale < 0 ? 1 - scale * nearest : 1;
  return {.srgb = false, .scale = Vec3(scale), .offset = Vec3(offset)};
}

/// Maps the bounding box to [0, 1].
Display of_positions(const Film& film) {
  Vec3 low(kInfinity), high(-kInfinity);
  for_each_pixel(film, [&](const Vec3& value) {
    if (value == Vec3(0)) return;  // most likely the ray hits no surface
    low = glm::min(low, value);
    high = glm::max(high, value);
  });
  Display display{.srgb = false};
  for (glm::length_t i = 0; i < 3; ++i) {
    const float range = high[i] - low[i];
    const bool has_range = range > 0 && std::isfinite(range);
    display.scale[i] = has_range ? 1 / range : 0;
    display.offset[i] = has_range ? -low[i] / range : 0.5F;
  }
  return display;
}

}  // namespace

void AovIntegrator::trace(const World& world, std::span<const Ray> rays,
                          std::span<const SampleId> /*ids*/, std::span<Sample> samples) const {
  const Sights sights(world, rays, {aov_});
  Sights::Values<float> v;
  if (aov_ != Aov::id) sights.values_of(aov_, v);
  std::array<std::uint32_t, Sights::kSize> ids;
  if (aov_ == Aov::id) sights.ids(0, ids);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    Vec3 color;
    if (aov_ == Aov::id)
      color = sights.is_seen(i) ? color_of_id(ids[i]) : Vec3(0);
    else if (channels_of(aov_).size() == 1)
      color = Vec3(v[0][i]);
    else if (channels_of(aov_).size() == 2)
      color = {v[0][i], v[1][i], 0};
    else
      color = {v[0][i], v[1][i], v[2][i]};
    samples[i] = {.color = color, .alpha = sights.is_seen(i) ? 1.0F : 0.0F};
  }
}

Display AovIntegrator::display(const Film& film) const {
  const FloatEnvironment environment;
  switch (aov_) {
    case Aov::depth:
    case Aov::distance:
      return of_lengths(film);
    case Aov::position:
      return of_positions(film);
    case Aov::normal:
    case Aov::face_normal:
      return {.srgb = false, .scale = Vec3(0.5F), .offset = Vec3(0.5F)};
    case Aov::albedo:
      return {};
    case Aov::uv:
    case Aov::barycentric:
    case Aov::id:
      break;
  }
  return {.srgb = false};
}

}  // namespace microtrace
