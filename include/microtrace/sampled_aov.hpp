#pragma once
/// Statistics of a Monte Carlo pixel's samples, as channels beside the colors. Unlike the
/// quantities of aov.hpp they are means, with the same filter as the colors.

#include <microtrace/export.hpp>

#include <array>
#include <optional>
#include <string_view>

namespace microtrace {

/// To add one: a value here and in kSampledAovs, its channels and its value in
/// src/render/aovs/sampled_aov_painter.cpp, its help text in src/cli/options/picture_options.cpp, a
/// line in docs/outputs.md, a test in tests/unit/sampled_aov_test.cpp.
enum class SampledAov {
  variance,        ///< Y: estimated variance of the mean luminance (PixelSum::variance)
  samples,         ///< N: number of samples of the pixel
  denoise_albedo,  ///< R, G, B: base color of the first visible surface, in [0, 1]; 0 without a
                   ///< surface
  denoise_normal,  ///< X, Y, Z: its shading normal in world space, facing the viewer; 0 without
                   ///< a surface; shorter than 1 where normals differ
};

inline constexpr std::array kSampledAovs = {SampledAov::variance, SampledAov::samples,
                                            SampledAov::denoise_albedo, SampledAov::denoise_normal};

/// The name on the command line, and before the dot in channel names.
[[nodiscard]] MICROTRACE_EXPORT std::string_view name_of(SampledAov aov);
[[nodiscard]] MICROTRACE_EXPORT std::optional<SampledAov> sampled_aov_named(std::string_view name);

}  // namespace microtrace
