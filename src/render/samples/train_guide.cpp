#include "render/samples/train_guide.hpp"

#include "base/idle_objects.hpp"
#include "base/memory_account.hpp"
#include "base/system/float_environment.hpp"
#include "render/film/camera_rays.hpp"
#include "render/guiding/robust_mean.hpp"
#include "render/integrators/wavefront/wave.hpp"
#include "render/sampling/dimensions.hpp"
#include "render/sampling/sobol.hpp"
#include "scene/math/luminance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

namespace microtrace {
namespace {

/// The numbers of paths per cell of the training picture, pass by pass. Later passes are guided by
/// what the earlier ones learned.
constexpr std::array<std::uint32_t, 3> kPaths = {2, 4, 10};
/// The limits of the number of cells, which is half the number of pixels between them.
constexpr double kLeastCells = 4096, kMostCells = 32768;

/// The seed of training paths, which differ from those of the picture.
std::uint32_t training_seed(std::uint32_t seed) {
  return sampling::hash(seed, 0x74726169U);
}

/// The number of cells, with the picture's aspect ratio.
ImageSize training_size(ImageSize size) {
  const double pixels = double{1} * size.width * size.height;
  const double scale = std::sqrt(std::clamp(pixels / 2, kLeastCells, kMostCells) / pixels);
  const auto side = [&](std::uint32_t edge) {
    return std::max(static_cast<std::uint32_t>(edge * scale), 1U);
  };
  return {.width = side(size.width), .height = side(size.height)};
}

/// Traces training paths, on any number of threads.
class Trainer {
 public:
  Trainer(const World& world, const PathOptions& options, ImageSize size, ImageSize cells)
      : world_(world), options_(options), ray_(world.camera, world.scene) {
    scale_ = {double{1} * size.width / cells.width, double{1} * size.height / cells.height};
  }

  /// Traces the paths `first` to `last` of each of the tile's cells.
  void trace(const PixelRect& tile, std::uint32_t first, std::uint32_t last) {
    std::unique_ptr<Worker> worker = workers_.take();
    std::size_t count = 0;
    for (std::uint32_t k = first; k < last; ++k) {
      for (std::uint32_t y = tile.y0; y < tile.y1; ++y) {
        for (std::uint32_t x = tile.x0; x < tile.x1; ++x) {
          const std::uint32_t key = sampling::pixel_key(training_seed(world_.seed), x, y);
          const sampling::Sobol sobol(key, k);
          const Vec2 at = sobol.pair(sampling::kPixelPair);
          const Ray ray = ray_.sample((x + double{at.x}) * scale_.x, (y + double{at.y}) * scale_.y,
                                      sobol.pair(sampling::kLensPair));
          worker->rays[count] = ray;
          worker->ids[count++] = {.x = x, .y = y, .index = k, .key = key};
        }
      }
    }
    worker->wave.trace(world_, options_, std::span(worker->rays).first(count),
                       std::span(worker->ids).first(count), std::span(worker->samples).first(count),
                       &worker->records);
    for (std::size_t i = 0; i < count; ++i)
      worker->luminances.push_back(luminance(worker->samples[i].color));
    workers_.give(std::move(worker));
  }

  /// Moves the records of all threads to `all`, in any order.
  void collect(GuideRecords& all) {
    workers_.for_each([&](Worker& worker) {
      luminances_.insert(luminances_.end(), worker.luminances.begin(), worker.luminances.end());
      worker.luminances.clear();
      for (std::size_t face = 0; face < all.size(); ++face) {
        std::vector<GuideRecord>& own = worker.records[face];
        all[face].insert(all[face].end(), own.begin(), own.end());
        memory_.take(own.size() * kCopies * sizeof(GuideRecord), "the training paths");
        own.clear();
      }
    });
  }

  /// The mean luminance of the samples that were collected.
  [[nodiscard]] float brightness() const {
    return static_cast<float>(RobustMean(luminances_, [](float x) { return x; }).mean());
  }

 private:
  struct Worker {
    Wave wave;
    GuideRecords records;
    std::vector<float> luminances;  ///< of the samples
    std::array<Ray, kRandomBatch> rays;
    std::array<SampleId, kRandomBatch> ids;
    std::array<Sample, kRandomBatch> samples;
  };

  static constexpr std::uint64_t kCopies = 3;  // of a thread, of all threads, and for the guide

  const World& world_;
  const PathOptions& options_;
  CameraRays ray_;
  MemoryAccount memory_{memory_account().budget()};
  std::vector<float> luminances_;
  DVec2 scale_;
  IdleObjects<Worker> workers_;
};

}  // namespace

std::unique_ptr<const PathGuide> train_guide(const World& untrained, const PathOptions& options,
                                             ImageSize size, Threads& threads,
                                             const std::function<bool(double)>& progress) {
  World world = untrained;
  const ImageSize cells = training_size(size);
  const PixelRect all{.x0 = 0, .y0 = 0, .x1 = cells.width, .y1 = cells.height};
  Trainer trainer(world, options, size, cells);
  GuideRecords records;
  std::unique_ptr<const PathGuide> guide;
  std::uint32_t first = 0;
  for (const std::uint32_t paths : kPaths) {
    const auto trace = [&](const PixelRect& tile, const auto& /*poll*/) {
      const FloatEnvironment environment;
      trainer.trace(tile, first, first + paths);
    };
    for_each_tile(all, threads, trace, progress);
    trainer.collect(records);
    guide = std::make_unique<const PathGuide>(records, trainer.brightness());
    world.guide = guide.get();
    first += paths;
  }
  return guide;
}

}  // namespace microtrace
