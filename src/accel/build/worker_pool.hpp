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

/// A pool of threads that execute loops together with the calling thread.
class WorkerPool {
 public:
  /// 0: default_threads(). Starts fewer if the system refuses more.
  explicit WorkerPool(unsigned threads);
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  /// Calls f(0) ... f(count - 1) concurrently, in any order, and returns when all are done. If
  /// calls throw, rethrows one of the exceptions and drops calls that have not started.
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
