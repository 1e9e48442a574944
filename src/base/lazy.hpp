#pragma once
#include <atomic>
#include <memory>
#include <mutex>

namespace microtrace {

/// A value that is made on first use. Any number of threads may call get(); one of them makes the
/// value.
template <class T>
class Lazy {
 public:
  /// Returns the value. make() must return a std::unique_ptr<T>. If make() throws, the next call
  /// tries again.
  template <class Make>
  const T& get(const Make& make) const {
    if (const T* made = value_.load(std::memory_order_acquire)) return *made;
    const std::scoped_lock lock(mutex_);
    if (!owner_) {
      owner_ = make();
      value_.store(owner_.get(), std::memory_order_release);
    }
    return *owner_;
  }

 private:
  mutable std::mutex mutex_;
  mutable std::unique_ptr<const T> owner_;
  mutable std::atomic<const T*> value_{nullptr};
};

}  // namespace microtrace
