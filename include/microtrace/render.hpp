#pragma once
/// From a scene to a picture.

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

/// Where the time of a rendering went, in seconds.
struct RenderTimes {
  double build = 0;  ///< making the tree
  double trace = 0;  ///< drawing
};

/// What was done.
struct RenderCounts {
  std::uint64_t samples = 0;            ///< camera rays traced, of all pixels
  std::uint64_t invalid_samples = 0;    ///< of random integrators, no numbers: counted as black
  std::uint32_t samples_per_pixel = 0;  ///< the most that a pixel of the picture has
  RayCounts rays{};                     ///< the integrator's, of all its pictures so far
  StageCounts stages{};                 ///< where visibility was decided
  std::uint32_t missing_threads = 0;    ///< threads that the system refused to start
};

/// How the samples around a pixel's centre weigh in its colour. They lie as dense as the filter is
/// high, so that all weigh the same and no pixel depends on another's samples.
enum class PixelFilter {
  box,              ///< the pixel's square, evenly
  blackman_harris,  ///< a bell, 3 pixels wide in x and in y (radius 1.5)
};

/// Samples of a random integrator taken a few at a time over the whole picture, so that it may be
/// looked at, stopped and gone on with. How passes are cut has no influence on the picture.
struct Passes {
  /// Goes on from these, which may have any samples of this window of this picture, and leaves all
  /// there; null: from none. Of no use where render throws.
  SampleSums* sums = nullptr;
  /// Takes only these of the samples; nothing: all.
  std::optional<SampleRange> part{};
  /// If above 0, tiles of 8 x 8 pixels whose error (docs/outputs.md) is not above it, nor that of
  /// the eight around them, take no more samples. Asked at 32, 64, 128, ... samples. Not with a
  /// part.
  double target_error = 0;
  /// No pass begins so many seconds after the call, but the first does.
  double time_limit = std::numeric_limits<double>::infinity();
  /// Told what there is after each pass, on the caller's thread.
  std::function<void(const SampleSums&)> after_each{};
};

struct RenderOptions {
  unsigned threads = 0;  ///< 0: default_threads()
  /// Runs work() on up to `threads` threads of the host at a time, the caller's among them if it
  /// likes, and returns when all calls have returned; one call is enough to do all the work, which
  /// does not throw. Null: render starts threads of its own.
  std::function<void(unsigned threads, const std::function<void()>& work)> run_threads{};
  /// Called with the fraction of the picture that is done, in (0, 1]; by one thread at a time, not
  /// always the caller's. If it returns false, render stops at once and throws Error (canceled).
  std::function<bool(double)> progress{};
  RenderTimes* times = nullptr;            ///< if given, set at the end
  const Integrator* integrator = nullptr;  ///< null: FlatIntegrator
  /// Rays for each pixel, 1 to kMaxSamples. One goes through its centre. More are spread over its
  /// square, in the same places in each pixel, and weigh the same: sample k of n lies at x = (k +
  /// 1/2) / n, y = (r(k) + 1/2) / n, where r puts the numbers 0 to n - 1 in the order of van der
  /// Corput's sequence. Integrators whose answers are random get rays through random places, even
  /// if there is one.
  std::uint32_t samples = 1;
  PixelFilter filter = PixelFilter::box;  ///< another moves samples from where they lie for a box
  std::uint32_t seed = 0;                 ///< of all that is random; another one gives other noise
  /// Takes passes over the picture. They need 88 bytes a pixel; nothing: tiles are finished one by
  /// one.
  std::optional<Passes> passes{};
  RenderCounts* counts = nullptr;  ///< if given, set at the end
  MemoryBudget* memory = nullptr;  ///< if given, counts what the call takes until it returns
  std::optional<Environment> environment{};  ///< in place of the scene's
  std::optional<Vec3> background{};          ///< in place of the scene's; linear Rec. 709
  /// Draws only this part, with the same pixels that it has in the whole. Not empty, within the
  /// size.
  std::optional<PixelRect> crop{};
  /// Channels of the film beside the colours, in this order; each once.
  std::vector<Aov> aovs{};
  /// Means over the samples of a random integrator as further channels behind these; each once.
  std::vector<SampledAov> sampled_aovs{};
  bool transparent = false;  ///< leaves the background out and gives the film alpha
};

/// Draws a picture: colors by the integrator, composited over scene.background; rays hit only in
/// (scene.epsilon, infinity). The camera is in the scene's own coordinates, as Scene::cameras are.
/// Threads, progress and times have no influence on the picture. Throws Error: usage where samples,
/// passes, crop or aovs are not as above, an integrator of data is asked for more than one sample,
/// or one that is not random for passes; limit where memory runs out; canceled. Any number of
/// threads may render one scene at a time.
[[nodiscard]] MICROTRACE_EXPORT Film render(const PreparedScene& scene, const Camera& camera,
                                            ImageSize size, const RenderOptions& options = {});

/// The same for a single picture. Throws what PreparedScene throws, too.
[[nodiscard]] MICROTRACE_EXPORT Film render(const Scene& scene, const Camera& camera,
                                            ImageSize size, const RenderOptions& options = {});

}  // namespace microtrace
