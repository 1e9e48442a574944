#pragma once
#include <array>
#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>
#include <vector>

namespace microtrace {

/// A fixed number of values, each of which is made once, on first use. Any number of threads may
/// call get().
template <class T>
class LazyCells {
 public:
  LazyCells() = default;
  LazyCells(const LazyCells&) = delete;
  LazyCells& operator=(const LazyCells&) = delete;
  ~LazyCells() {
    for (const auto& cell : cells_) delete cell.load(std::memory_order_relaxed);
  }

  [[nodiscard]] std::size_t count() const { return cells_.size(); }
  /// Sets the number of values, once, before the first call of get().
  void resize(std::size_t count) { cells_ = std::vector<std::atomic<const T*>>(count); }

  /// make() must return a std::unique_ptr<const T> and not call get() of this object.
  template <class Make>
  const T& get(std::size_t index, const Make& make) const {
    std::atomic<const T*>& cell = cells_[index];
    if (const T* made = cell.load(std::memory_order_acquire)) return *made;
    const std::scoped_lock lock(mutexes_[index % mutexes_.size()]);
    if (const T* made = cell.load(std::memory_order_relaxed)) return *made;
    const T* made = make().release();
    cell.store(made, std::memory_order_release);
    return *made;
  }

 private:
  mutable std::vector<std::atomic<const T*>> cells_;
  mutable std::array<std::mutex, 64> mutexes_;  // each for some of the cells
};

}  // namespace microtrace
