#include "scene/tone_map.hpp"

#include "scene/math/exponential.hpp"

#include <algorithm>
#include <array>

#include <glm/common.hpp>
#include <glm/mat3x3.hpp>

namespace microtrace {
namespace {

/// Makes a matrix from its rows, because publications print matrices by rows.
constexpr glm::dmat3 matrix(const DVec3& a, const DVec3& b, const DVec3& c) {
  return {a.x, b.x, c.x, a.y, b.y, c.y, a.z, b.z, c.z};
}

template <class F>
DVec3 each(const DVec3& v, F&& f) {
  return {f(v.x), f(v.y), f(v.z)};
}

/// Khronos PBR Neutral Tone Mapper, specification of 2024. The first step subtracts the specular
/// reflection of a surface with reflectance 0.04. The second compresses a largest channel above
/// 0.76 into [0.76, 1] and desaturates very bright colors.
DVec3 khronos_pbr_neutral(const DVec3& light) {
  constexpr double kStart = 0.8 - 0.04, kDesaturation = 0.15;
  const double least = std::min({light.x, light.y, light.z});
  const double offset = least < 0.08 ? least - 6.25 * least * least : 0.04;
  const DVec3 color = light - offset;
  const double peak = std::max({color.x, color.y, color.z});
  if (peak < kStart) return color;
  constexpr double kRoom = 1 - kStart;
  const double shown = 1 - kRoom * kRoom / (peak + kRoom - kStart);
  const double gray = 1 - 1 / (kDesaturation * (peak - shown) + 1);
  return glm::mix(color * (shown / peak), DVec3(shown), gray);
}

/// S. Hill's fit of the ACES reference rendering and output transforms (BakingLab, 2016), with the
/// exposure factor 1 / 0.6 of three.js.
DVec3 aces(const DVec3& light) {
  static const glm::dmat3 aces_from_rec709 =
      matrix({0.59719, 0.35458, 0.04823}, {0.07600, 0.90834, 0.01566}, {0.02840, 0.13383, 0.83777});
  static const glm::dmat3 rec709_from_aces = matrix(
      {1.60475, -0.53108, -0.07367}, {-0.10208, 1.10813, -0.00605}, {-0.00327, -0.07276, 1.07602});
  const DVec3 fitted = each(aces_from_rec709 * (light / 0.6), [](double v) {
    return (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081);
  });
  return rec709_from_aces * fitted;
}

/// AgX's base contrast curve over its logarithmic range: B. Wrensch's polynomial fit ("Minimal AgX
/// implementation", 2023).
double agx_contrast(double x) {
  const double x2 = x * x, x4 = x2 * x2;
  return 15.5 * x4 * x2 - 40.14 * x4 * x + 31.96 * x4 - 6.868 * x2 * x + 0.4298 * x2 + 0.1191 * x -
         0.00232;
}

/// T. Sobotka's AgX in Rec. 2020 primaries, as in Blender and Filament. It covers 16.5 stops around
/// middle gray. The display's power function of 2.2 is not part of it.
DVec3 agx(const DVec3& light) {
  static const glm::dmat3 rec2020_from_rec709 =
      matrix({0.6274, 0.3293, 0.0433}, {0.0691, 0.9195, 0.0113}, {0.0164, 0.0880, 0.8956});
  static const glm::dmat3 rec709_from_rec2020 =
      matrix({1.6605, -0.5876, -0.0728}, {-0.1246, 1.1329, -0.0083}, {-0.0182, -0.1006, 1.1187});
  static const glm::dmat3 inset =
      matrix({0.856627153315983, 0.0951212405381588, 0.0482516061458583},
             {0.137318972929847, 0.761241990602591, 0.101439036467562},
             {0.11189821299995, 0.0767994186031903, 0.811302368396859});
  static const glm::dmat3 outset =
      matrix({1.1271005818144368, -0.11060664309660323, -0.016493938717834573},
             {-0.1413297634984383, 1.157823702216272, -0.016493938717834257},
             {-0.14132976349843826, -0.11060664309660294, 1.2519364065950405});
  constexpr double kLeast = -12.47393,
                   kGreatest = 4.026069;  // log2(0.18) - 10 and log2(0.18) + 6.5
  const DVec3 shown = each(inset * (rec2020_from_rec709 * light), [](double v) {
    const double stops = (binary_logarithm(std::max(v, 1e-10)) - kLeast) / (kGreatest - kLeast);
    return agx_contrast(std::clamp(stops, 0.0, 1.0));
  });
  const DVec3 linear = each(outset * shown, [](double v) {
    return v > 0 ? power_of_two(2.2 * binary_logarithm(std::max(v, 1e-100))) : 0.0;
  });
  return rec709_from_rec2020 * linear;
}

DVec3 mapped(const DVec3& light, ToneMap map) {
  switch (map) {
    case ToneMap::khronos_pbr_neutral:
      return khronos_pbr_neutral(light);
    case ToneMap::aces:
      return aces(light);
    case ToneMap::agx:
      return agx(light);
    case ToneMap::none:
      break;
  }
  return light;
}

}  // namespace

Vec3 tone_mapped(const Vec3& color, ToneMap map) {
  if (map == ToneMap::none) return color;
  const auto from_zero_to = [](double greatest) {
    return [=](double v) { return v > 0 ? std::min(v, greatest) : 0.0; };
  };
  return Vec3(each(mapped(each(DVec3(color), from_zero_to(1e6)), map), from_zero_to(1)));
}

std::string_view name_of(ToneMap map) {
  constexpr std::array<std::string_view, kToneMaps.size()> kNames = {"none", "khronos-pbr-neutral",
                                                                     "aces", "agx"};
  return kNames[static_cast<std::size_t>(map)];
}

std::optional<ToneMap> tone_map_named(std::string_view name) {
  for (const ToneMap map : kToneMaps) {
    if (name_of(map) == name) return map;
  }
  return std::nullopt;
}

}  // namespace microtrace
