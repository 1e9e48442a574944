#pragma once
#include "base/system/start_threads.hpp"

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <vector>

namespace microtrace::build {

/// A pool of threads that execute loops together with the calling thread.
class WorkerPool {
 public:
  /// Starts threads - 1 threads, or fewer if the system refuses more. 0 means default_threads().
  explicit WorkerPool(unsigned threads);
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  /// The number of threads, including the calling one.
  [[nodiscard]] std::size_t size() const { return threads_.size() + 1; }

  /// Calls f(0) ... f(count - 1) concurrently, in any order, and returns when all calls are done.
  /// If a call throws, skips calls that have not started and rethrows one of the exceptions.
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
  std::vector<Thread> threads_;
};

}  // namespace microtrace::build
