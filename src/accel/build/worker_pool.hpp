#pragma once
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace microtrace::build {

/// Threads that share loops, the caller's among them.
class WorkerPool {
 public:
  /// 0: as many as the machine runs at once. Fewer where the system starts no more.
  explicit WorkerPool(unsigned threads);
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  /// f(0) ... f(count - 1), in any order and at once; returns when all have. If some throw, one of
  /// the exceptions is thrown here and calls not yet begun are dropped.
  void run(std::size_t count, const std::function<void(std::size_t)>& f);

 private:
  void work();
  void take_turns();

  std::mutex mutex_;
  std::condition_variable begin_, end_;
  const std::function<void(std::size_t)>* task_ = nullptr;
  std::size_t count_ = 0, round_ = 0, busy_ = 0;
  std::atomic<std::size_t> next_{0};
  std::exception_ptr failure_;
  bool stop_ = false;
  std::vector<std::jthread> threads_;
};

}  // namespace microtrace::build
