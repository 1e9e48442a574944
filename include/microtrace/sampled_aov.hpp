#pragma once
/// Quantities of the samples that pixels of random integrators are made of, as channels beside the
/// colours. Unlike those of aov.hpp they are means, over the same filter as the colours.

#include <microtrace/export.hpp>

#include <array>
#include <optional>
#include <string_view>

namespace microtrace {

/// To add one: a value here and in kSampledAovs, its row and its value in
/// src/render/sampled_aov_painter.cpp, a line in docs/outputs.md.
enum class SampledAov {
  variance,        ///< Y: of the mean of the luminance shown, estimated (PixelSum::variance)
  samples,         ///< N: how many samples the pixel has
  denoise_albedo,  ///< R, G, B: base colour of what is seen first, in [0, 1]; 0 where nothing is
  denoise_normal,  ///< X, Y, Z: its shading normal in world space, on the side that is seen; 0
                   ///< where nothing is; shorter than 1 where normals differ
};

inline constexpr std::array kSampledAovs = {SampledAov::variance, SampledAov::samples,
                                            SampledAov::denoise_albedo, SampledAov::denoise_normal};

/// As above; on the command line, and before the dot in the names of channels.
[[nodiscard]] MICROTRACE_EXPORT std::string_view name_of(SampledAov aov);
[[nodiscard]] MICROTRACE_EXPORT std::optional<SampledAov> sampled_aov_named(std::string_view name);

}  // namespace microtrace
