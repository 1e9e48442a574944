#pragma once
/// Removes noise from path-traced pictures by Open Image Denoise 2. This library is loaded at run
/// time, so neither building nor running anything else needs it.

#include <microtrace/camera.hpp>
#include <microtrace/export.hpp>
#include <microtrace/film.hpp>
#include <microtrace/prepared_scene.hpp>
#include <microtrace/render.hpp>
#include <microtrace/sampled_aov.hpp>

#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace microtrace {

/// The channels that Denoiser::denoise() needs.
inline constexpr std::array kDenoiseFeatures = {SampledAov::denoise_albedo,
                                                SampledAov::denoise_normal, SampledAov::emission,
                                                SampledAov::denoise_emission};

/// The library for denoising. May be used by any number of threads.
class MICROTRACE_EXPORT Denoiser {
 public:
  /// Loads libOpenImageDenoise.so.2 from the file or folder that MICROTRACE_OIDN_PATH names. If the
  /// variable is not set, searches the folder of microtrace's modules and then the dynamic linker's
  /// folders. Throws Error (unsupported) if the library is missing or can't be used; the message
  /// states the remedy. Call this constructor before a long rendering.
  Denoiser();
  ~Denoiser();
  Denoiser(Denoiser&&) noexcept;
  Denoiser& operator=(Denoiser&&) noexcept;

  /// Returns the library's name and version, "Open Image Denoise 2.3.2".
  [[nodiscard]] std::string name() const;

  /// Replaces the film's colors by denoised ones. The film must be a picture of PathIntegrator with
  /// the channels of kDenoiseFeatures. Channels remain unchanged, and so do colors where
  /// no surface is visible, except for edges of lamps. Light that reaches the camera without being
  /// scattered (the channel emission) has no noise; only the rest of each color is filtered. If
  /// Film::has_lens or Film::has_ground is true, channels contain noise: they are filtered before
  /// their use, and the background, alpha and emission are filtered, too. Otherwise, alpha remains
  /// unchanged. Sets Film::denoiser.
  ///
  /// Only the options threads, progress and memory have an effect. The library starts its own
  /// threads. Throws Error: usage if a channel
  /// is missing, limit if memory runs out, canceled if options.progress returns false, internal if
  /// the library fails.
  void denoise(Film& film, const RenderOptions& options = {}) const;

  /// Renders a picture and denoises it. Renders the channels of kDenoiseFeatures even if the
  /// options don't ask for them, but returns only those that were asked for. The integrator must be
  /// a PathIntegrator. Throws the errors of render() and denoise().
  [[nodiscard]] Film render(const PreparedScene& scene, const Camera& camera, ImageSize size,
                            RenderOptions options) const;

 private:
  struct MICROTRACE_HIDDEN Library;
  std::unique_ptr<const Library> library_;
};

/// Adds the channels of kDenoiseFeatures that the options lack.
MICROTRACE_EXPORT void add_denoise_features(RenderOptions& options);

/// Returns true if channels of kDenoiseFeatures are missing.
[[nodiscard]] MICROTRACE_EXPORT bool lacks_denoise_features(std::span<const Channel> channels);

/// Returns the names of the channels of kDenoiseFeatures that `wanted` doesn't contain, sorted.
[[nodiscard]] MICROTRACE_EXPORT std::vector<std::string> channels_only_for_denoising(
    std::span<const Channel> channels, std::span<const SampledAov> wanted);

/// Removes the channels of these names, which are sorted.
MICROTRACE_EXPORT void remove_channels(Film& film, std::span<const std::string> names);

}  // namespace microtrace
