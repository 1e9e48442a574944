#pragma once
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace microtrace {

/// Objects that no thread is using, kept because making one is expensive. Any number of threads may
/// take and give.
template <class T>
class IdleObjects {
 public:
  /// Returns an idle object, or a new one if there is none.
  [[nodiscard]] std::unique_ptr<T> take() {
    const std::scoped_lock lock(mutex_);
    if (objects_.empty()) return std::make_unique<T>();
    std::unique_ptr<T> object = std::move(objects_.back());
    objects_.pop_back();
    return object;
  }

  void give(std::unique_ptr<T> object) {
    const std::scoped_lock lock(mutex_);
    objects_.push_back(std::move(object));
  }

  /// Calls f for each idle object. No thread may take or give one meanwhile.
  template <class F>
  void for_each(const F& f) {
    for (const auto& object : objects_) f(*object);
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<T>> objects_;
};

}  // namespace microtrace
