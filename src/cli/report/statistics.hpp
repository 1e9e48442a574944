#pragma once
#include "cli/arguments.hpp"

#include <microtrace/io.hpp>
#include <microtrace/memory.hpp>
#include <microtrace/render.hpp>

#include <chrono>
#include <cstdint>

namespace microtrace::cli {

/// Measures the stages of a run.
class Stopwatch {
 public:
  using Clock = std::chrono::steady_clock;

  // Each of these functions ends a stage.
  void loaded(const LoadTimes& times) {
    load_ = lap();
    load_times_ = times;
  }
  void rendered(const RenderTimes& times) {
    render_ = lap();
    times_ = times;
  }
  void written() { write_ = lap(); }

  /// Returns the time for loading, rendering and writing.
  [[nodiscard]] double seconds() const { return load_ + render_ + write_; }

  /// Prints times, numbers of rays and memory use to standard error.
  void report(Statistics kind, const Scene& scene, ImageSize size, const RenderCounts& counts,
              unsigned threads, const MemoryBudget& memory) const;

 private:
  double lap();

  Clock::time_point last_ = Clock::now();
  double load_ = 0, render_ = 0, write_ = 0;
  LoadTimes load_times_{};
  RenderTimes times_{};
};

}  // namespace microtrace::cli
