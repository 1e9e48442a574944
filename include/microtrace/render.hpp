#pragma once
/// Rendering of pictures.

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
#include <microtrace/stage_counts.hpp>

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

namespace microtrace {

inline constexpr std::uint32_t kMaxSamples = 65536;

/// The time of each step of a rendering, in seconds.
struct RenderTimes {
  double build = 0;  ///< building the tree
  double trace = 0;  ///< tracing and shading
};

/// Statistics of a rendering.
struct RenderCounts {
  std::uint64_t samples = 0;            ///< camera rays of all pixels
  std::uint64_t invalid_samples = 0;    ///< NaN samples, which count as black
  std::uint32_t samples_per_pixel = 0;  ///< maximum over the pixels
  RayCounts rays{};                     ///< of the integrator, for all its pictures so far
  StageCounts stages{};                 ///< visibility queries by stage
  std::uint32_t missing_threads = 0;    ///< threads that the system refused to start
};

/// The pixel filter. Samples are distributed with the density of the filter, so all have the same
/// weight and no pixel depends on another pixel's samples.
enum class PixelFilter {
  box,              ///< uniform over the pixel's square
  blackman_harris,  ///< a bell, 3 pixels wide in x and in y (radius 1.5)
};

/// Adds a few samples per pass to the whole picture, so that the picture can be displayed, stopped
/// and resumed. The division into passes has no effect on the result.
struct Passes {
  /// Continues from these sums, which may have any samples of this window of this picture, and
  /// stores all samples there; null: starts without samples. Must not be used after render throws.
  SampleSums* sums = nullptr;
  /// Takes only these of the samples; nothing: all.
  std::optional<SampleRange> part{};
  /// If above 0, tiles of 8 x 8 pixels take no more samples when their error (docs/outputs.md) and
  /// those of the eight neighboring tiles are at most this. Evaluated at 32, 64, 128, ... samples.
  /// Not with a part.
  double target_error = 0;
  /// No pass starts later than this many seconds after the call, except the first.
  double time_limit = std::numeric_limits<double>::infinity();
  /// Called after each pass with the samples so far, on the caller's thread.
  std::function<void(const SampleSums&)> after_each{};
};

struct RenderOptions {
  unsigned threads = 0;  ///< 0: default_threads()
  /// Runs work() on up to `threads` threads of the host at the same time, possibly including the
  /// caller's, and returns when all calls have returned. One call of work() is enough to finish
  /// everything. work() does not throw. Null: render starts its own threads.
  std::function<void(unsigned threads, const std::function<void()>& work)> run_threads{};
  /// Called with the fraction of the picture that is done, in (0, 1]; by one thread at a time, not
  /// always the caller's. If it returns false, render stops at once and throws Error (canceled).
  std::function<bool(double)> progress{};
  RenderTimes* times = nullptr;            ///< if given, set at the end
  const Integrator* integrator = nullptr;  ///< not owned; null: FlatIntegrator
  /// Samples per pixel, 1 to kMaxSamples. A single ray goes through the pixel's center. Several are
  /// distributed over its square, at the same positions in each pixel and with the same weight:
  /// sample k of n is at x = (k + 1/2) / n, y = (r(k) + 1/2) / n, where r is the order of the
  /// numbers 0 to n - 1 in van der Corput's sequence. Monte Carlo integrators get random positions,
  /// even for a single ray.
  std::uint32_t samples = 1;
  PixelFilter filter = PixelFilter::box;  ///< others move the samples of the box
  std::uint32_t seed = 0;                 ///< random seed; another seed gives other noise
  /// Renders in passes, which need 88 bytes per pixel; nothing: finishes tile by tile.
  std::optional<Passes> passes{};
  RenderCounts* counts = nullptr;  ///< if given, set at the end
  MemoryBudget* memory = nullptr;  ///< if given, counts the memory of the call until it returns
  std::optional<Environment> environment{};  ///< replaces the scene's
  std::optional<Vec3> background{};          ///< replaces the scene's; linear Rec. 709
  /// Renders only this part, with the same pixels as in the whole. Not empty, within the size.
  std::optional<PixelRect> crop{};
  /// Channels of the film in addition to the colors, in this order, without duplicates.
  std::vector<Aov> aovs{};
  /// Means over the samples of a Monte Carlo integrator, as further channels after these, without
  /// duplicates.
  std::vector<SampledAov> sampled_aovs{};
  bool transparent = false;  ///< omits the background and gives the film alpha
};

/// Renders a picture: the integrator's colors composited over scene.background. Camera rays hit
/// only in (scene.epsilon, infinity). The camera is in scene coordinates, as in Scene::cameras. The
/// picture does not depend on threads, progress or times. Throws Error: usage for invalid samples,
/// passes, crop or aovs, for more than one sample of an integrator of data, or for passes of one
/// that is not a Monte Carlo integrator; limit if memory runs out; canceled. Many threads may
/// render one scene at the same time.
[[nodiscard]] MICROTRACE_EXPORT Film render(const PreparedScene& scene, const Camera& camera,
                                            ImageSize size, const RenderOptions& options = {});

/// The same for a single picture. Throws what PreparedScene throws, too.
[[nodiscard]] MICROTRACE_EXPORT Film render(const Scene& scene, const Camera& camera,
                                            ImageSize size, const RenderOptions& options = {});

}  // namespace microtrace
