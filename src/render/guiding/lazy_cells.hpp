#pragma once
#include <atomic>
#include <cstddef>
#include <memory>
#include <vector>

namespace microtrace {

/// A fixed number of values, each of which is made on first use and must depend only on its index.
/// Any number of threads may call get(). If several of them make a value at the same time, one
/// result is kept.
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

  /// make() must return a std::unique_ptr<const T>.
  template <class Make>
  const T& get(std::size_t index, const Make& make) const {
    std::atomic<const T*>& cell = cells_[index];
    if (const T* made = cell.load(std::memory_order_acquire)) return *made;
    std::unique_ptr<const T> own = make();
    const T* kept = nullptr;
    if (cell.compare_exchange_strong(kept, own.get(), std::memory_order_acq_rel))
      kept = own.release();
    return *kept;
  }

 private:
  mutable std::vector<std::atomic<const T*>> cells_;
};

}  // namespace microtrace
