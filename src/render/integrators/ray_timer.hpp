#pragma once
#include <microtrace/path.hpp>

#include <chrono>
#include <cstddef>

namespace microtrace {

/// Adds the number of rays, and the time between construction and destruction, to the counts.
class RayTimer {
 public:
  RayTimer(RayCounts::Kind& kind, std::size_t rays) : kind_(kind) { kind.rays += rays; }
  ~RayTimer() { kind_.seconds += std::chrono::duration<double>(Clock::now() - start_).count(); }
  RayTimer(const RayTimer&) = delete;
  RayTimer& operator=(const RayTimer&) = delete;

 private:
  using Clock = std::chrono::steady_clock;
  RayCounts::Kind& kind_;
  Clock::time_point start_ = Clock::now();
};

}  // namespace microtrace
