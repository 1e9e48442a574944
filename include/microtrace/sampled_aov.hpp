#pragma once
/// Statistics of the samples of each pixel, for Monte Carlo integrators, stored as channels beside
/// the colors. Unlike the quantities of aov.hpp, they are computed from samples of a pixel, with
/// the same pixel filter as the colors. Those for denoising have numbers of samples of their own.

#include <microtrace/export.hpp>

#include <array>
#include <optional>
#include <string_view>

namespace microtrace {

/// To add a sampled AOV, add a value here and in kSampledAovs, its channels and its computation in
/// src/render/samples/sampled_aov_painter.cpp, its help text in
/// src/cli/options/picture_options.cpp, a line in docs/outputs.md, and a test in
/// tests/unit/render/sampled_aov_test.cpp.
enum class SampledAov {
  variance,          ///< Y: estimated variance of the mean luminance (PixelSum::variance)
  samples,           ///< N: number of samples of the pixel
  denoise_albedo,    ///< R, G, B: mean color of the surfaces that are seen directly, in mirrors and
                     ///< through smooth glass, without lighting, in [0, 1]
  denoise_normal,    ///< X, Y, Z: mean shading normal of these surfaces, world space, facing the
                     ///< viewer; shorter than 1 where normals differ between samples; 0 where the
                     ///< background is seen
  emission,          ///< R, G, B: mean light that arrives without being scattered: from emissive
                     ///< surfaces, the environment and the background, composited like the colors
  noisy,             ///< R, G, B: the colors before denoising
  denoise_emission,  ///< R, G, B: emission with at least 256 samples where surfaces may be visible
                     ///< that emit light without an emissive texture, so that their edges are
                     ///< smooth
};

inline constexpr std::array kSampledAovs = {SampledAov::variance,        SampledAov::samples,
                                            SampledAov::denoise_albedo,  SampledAov::denoise_normal,
                                            SampledAov::emission,        SampledAov::noisy,
                                            SampledAov::denoise_emission};

/// The AOV's name on the command line, which is also the part of channel names before the dot.
[[nodiscard]] MICROTRACE_EXPORT std::string_view name_of(SampledAov aov);
[[nodiscard]] MICROTRACE_EXPORT std::optional<SampledAov> sampled_aov_named(std::string_view name);

}  // namespace microtrace
