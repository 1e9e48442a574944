#include "accel/build/worker_pool.hpp"

#include "base/system/start_threads.hpp"

#include <microtrace/threads.hpp>

namespace microtrace::build {

WorkerPool::WorkerPool(unsigned threads) {
  if (threads == 0) threads = default_threads();
  threads_ = start_threads(threads - 1, [this] { work(); });
}

WorkerPool::~WorkerPool() {
  const std::lock_guard lock(mutex_);
  stop_ = true;
  begin_.notify_all();
}

void WorkerPool::run(std::size_t count, const std::function<void(std::size_t)>& f) {
  if (threads_.empty() || count < 2) {
    for (std::size_t i = 0; i < count; ++i) f(i);
    return;
  }
  std::unique_lock lock(mutex_);
  task_ = &f;
  count_ = count;
  next_ = 0;
  failure_ = nullptr;
  busy_ = threads_.size();
  ++round_;
  begin_.notify_all();
  lock.unlock();
  take_turns();
  lock.lock();
  end_.wait(lock, [this] { return busy_ == 0; });
  if (failure_) std::rethrow_exception(failure_);
}

void WorkerPool::work() {
  std::size_t seen = 0;
  std::unique_lock lock(mutex_);
  for (;;) {
    begin_.wait(lock, [&] { return stop_ || round_ != seen; });
    if (stop_) return;
    seen = round_;
    lock.unlock();
    take_turns();
    lock.lock();
    if (--busy_ == 0) end_.notify_one();
  }
}

void WorkerPool::take_turns() {
  try {
    for (std::size_t i = next_++; i < count_; i = next_++) (*task_)(i);
  } catch (...) {
    const std::lock_guard lock(mutex_);
    failure_ = std::current_exception();
    next_ = count_;
  }
}

}  // namespace microtrace::build
