#pragma once
/// Measures the duration of successive stages of loading.

#include <microtrace/io.hpp>

#include <chrono>

namespace microtrace::io {

class LoadClock {
 public:
  /// If `times` is null, nothing is recorded.
  explicit LoadClock(LoadTimes* times) : times_(times) {}

  /// Adds the time since the last call, or since construction, to this stage.
  void lap(double LoadTimes::*stage) {
    const auto now = std::chrono::steady_clock::now();
    if (times_ != nullptr) times_->*stage += std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }

 private:
  LoadTimes* times_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace microtrace::io
