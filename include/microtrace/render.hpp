#pragma once
/// Renders pictures.

#include <microtrace/aov.hpp>
#include <microtrace/camera.hpp>
#include <microtrace/environment.hpp>
#include <microtrace/export.hpp>
#include <microtrace/film.hpp>
#include <microtrace/integrator.hpp>
#include <microtrace/memory.hpp>
#include <microtrace/prepared_scene.hpp>
#include <microtrace/sample_sums.hpp>
#include <microtrace/sampled_aov.hpp>
#include <microtrace/scene.hpp>
#include <microtrace/shutter.hpp>
#include <microtrace/stage_counts.hpp>

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

namespace microtrace {

inline constexpr std::uint32_t kMaxSamples = 65536;

/// The wall-clock time of each step of a rendering, in seconds.
struct RenderTimes {
  double build = 0;    ///< building the tree
  double trace = 0;    ///< tracing and shading
  double denoise = 0;  ///< only if Denoiser::render() renders
};

/// Statistics of a rendering.
struct RenderCounts {
  std::uint64_t samples = 0;            ///< number of samples (camera rays) of all pixels
  std::uint64_t invalid_samples = 0;    ///< number of samples that were NaN, which count as black
  std::uint32_t samples_per_pixel = 0;  ///< the maximum over the pixels
  RayCounts rays{};                     ///< rays of the integrator, for all its pictures so far
  StageCounts stages{};                 ///< exact visibility tests by stage
  std::uint32_t missing_threads = 0;    ///< number of threads that the system refused to start
};

/// The pixel filter. Sample positions are distributed with the filter as their density. All samples
/// therefore have the same weight, and no pixel depends on another pixel's samples.
enum class PixelFilter {
  box,              ///< uniform over the pixel's square
  blackman_harris,  ///< a bell-shaped filter, 3 pixels wide in x and in y (radius 1.5)
};

/// Options for rendering in passes, each of which adds a few samples to every pixel. The unfinished
/// picture can then be displayed, and the rendering can be stopped and resumed. The division into
/// passes has no effect on the finished picture.
struct Passes {
  /// If not null, continues from the samples in these sums and adds those of each pass at its end.
  /// The sums must belong to the same part of the same picture and may hold any of its samples. If
  /// render() throws, they hold the passes that ended. If null, starts without samples.
  SampleSums* sums = nullptr;
  /// Takes only the samples in this range; nothing: all samples.
  std::optional<SampleRange> range{};
  /// If above 0, a tile of 8 x 8 pixels takes no more samples once its error (docs/outputs.md) and
  /// the errors of its eight neighbors are at most this value. The errors are evaluated at 32, 64,
  /// 128, ... samples. Can't be combined with `range`.
  double target_error = 0;
  /// No pass except the first starts later than this many seconds after the call of render().
  double time_limit = std::numeric_limits<double>::infinity();
  /// Called after each pass on the caller's thread, with the samples so far.
  std::function<void(const SampleSums&)> after_each{};
};

struct RenderOptions {
  unsigned threads = 0;  ///< 0: default_threads()
  /// If set, this function supplies the threads, for example from a host application's pool. It
  /// must call work() on up to `threads` threads at the same time, possibly including the caller's,
  /// and return when all calls have returned. A single call of work() also completes the rendering.
  /// work() does not throw. If none is called, render() throws Error (usage). If null, render()
  /// starts its own threads.
  std::function<void(unsigned threads, const std::function<void()>& work)> run_threads{};
  /// Called with the fraction of the picture that is done, in [0, 1]. Calls come from one thread at
  /// a time, but not always from the caller's. If the callback returns false, render() stops at
  /// once and throws Error (canceled).
  std::function<bool(double)> progress{};
  RenderTimes* times = nullptr;            ///< if not null, set at the end
  const Integrator* integrator = nullptr;  ///< not owned; null: FlatIntegrator
  /// Samples per pixel, 1 to kMaxSamples. A single sample is at the pixel's center. Several samples
  /// are distributed over the pixel's square at the same positions in each pixel, with equal
  /// weights. Sample k of n is at x = (k + 1/2) / n, y = (r(k) + 1/2) / n, where r(k) is the rank
  /// of element k among the first n elements of the van der Corput sequence. Monte Carlo
  /// integrators get random positions instead, even for a single sample.
  std::uint32_t samples = 1;
  PixelFilter filter = PixelFilter::box;  ///< others displace the box filter's samples
  std::uint32_t seed = 0;                 ///< random seed; a different seed gives different noise
  /// If set, renders in passes, which takes 88 bytes of memory per pixel, and another 88 bytes if
  /// Passes::sums is set. Otherwise the picture is finished tile by tile.
  std::optional<Passes> passes{};
  /// If set, the samples of a Monte Carlo integrator see the moments of this shutter. AOVs show the
  /// scene and the camera that are given to render(). Samples are taken in passes over all pixels,
  /// each of at least `shutter->times.count` samples per pixel unless fewer are wanted, which takes
  /// the memory of `passes`. Can't be combined with the denoising features of SampledAov.
  std::optional<Shutter> shutter{};
  RenderCounts* counts = nullptr;  ///< if not null, set at the end
  MemoryBudget* memory = nullptr;  ///< if not null, counts the memory of the call until it returns
  std::optional<Environment> environment{};  ///< replaces the scene's environment
  std::optional<Vec3> background{};          ///< replaces the scene's background; linear Rec. 709
  /// Renders only this part, whose pixels equal those of the whole picture. The part must not be
  /// empty and must lie within the picture.
  std::optional<PixelRect> crop{};
  /// AOVs to store as channels of the film in addition to the colors, in this order, without
  /// duplicates.
  std::vector<Aov> aovs{};
  /// Statistics of a Monte Carlo integrator's samples, to store as channels after those of `aovs`,
  /// without duplicates.
  std::vector<SampledAov> sampled_aovs{};
  bool transparent = false;  ///< omits the background and gives the film alpha
};

/// Renders a picture: the integrator's colors composited over the background. Camera rays hit only
/// in the open interval (Scene::epsilon, infinity). The camera is in scene coordinates, as in
/// Scene::cameras. The picture does not depend on threads, progress or times. Several threads may
/// render one scene at the same time.
///
/// Throws Error: invalid_scene for an invalid camera or environment (see validate.hpp); usage for
/// an empty picture, invalid samples, passes, crop or AOVs, for several samples per pixel if
/// Integrator::is_data(), for an invalid shutter, or for passes or a shutter with an integrator
/// that is not a Monte Carlo integrator; limit if memory runs out; canceled if options.progress
/// returns false.
[[nodiscard]] MICROTRACE_EXPORT Film render(const PreparedScene& scene, const Camera& camera,
                                            ImageSize size, const RenderOptions& options = {});

/// Prepares the scene and renders a single picture. Also throws the errors of PreparedScene's
/// constructor.
[[nodiscard]] MICROTRACE_EXPORT Film render(const Scene& scene, const Camera& camera,
                                            ImageSize size, const RenderOptions& options = {});

}  // namespace microtrace
