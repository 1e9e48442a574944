#pragma once
/// Work for single requests, beside the rendering of pictures.

#include "base/system/start_threads.hpp"

#include <atomic>
#include <functional>
#include <list>
#include <memory>
#include <vector>

namespace microtrace::cli {

class Errands {
 public:
  /// Runs `work`, which must not throw, on a thread of its own. Returns false if too many errands
  /// are running or the system refuses to start a thread. All calls must come from one thread.
  [[nodiscard]] bool run(std::function<void()> work);

  /// Returns true if no errand is running.
  [[nodiscard]] bool are_done();

 private:
  static constexpr std::size_t kMost = 4;

  struct Errand {
    std::shared_ptr<std::atomic<bool>> is_done;
    std::vector<Thread> thread;
  };
  void forget_done();

  std::list<Errand> errands_;
};

}  // namespace microtrace::cli
