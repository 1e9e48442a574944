#pragma once
/// Takes the time of one stage of loading after another.

#include <microtrace/io.hpp>

#include <chrono>

namespace microtrace::io {

class LoadClock {
 public:
  /// `times` may be null, and then nothing is noted.
  explicit LoadClock(LoadTimes* times) : times_(times) {}

  /// What has passed since the last call, or since the clock was made, was this stage.
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
