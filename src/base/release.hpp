#pragma once
#include "base/system/mapped_pages.hpp"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <span>
#include <vector>

namespace microtrace {

/// Returns the memory of a large PageVector to the system, as its elements are used for the last
/// time. Threads may call this at the same time.
template <class T>
class Release {
 public:
  explicit Release(std::span<T> all) : all_(all), used_((all.size() + kSize - 1) / kSize) {
    for (std::size_t i = 0; i < used_.size(); ++i) used_[i] = segment(i).size();
  }

  /// Elements that are no longer used. Each may be named only once.
  void operator()(std::size_t begin, std::size_t count) {
    for (const std::size_t end = begin + count; begin < end;) {
      const std::size_t i = begin / kSize, next = std::min(end, (i + 1) * kSize);
      if ((used_[i] -= next - begin) == 0)
        discard_pages(segment(i).data(), segment(i).size_bytes());
      begin = next;
    }
  }

 private:
  static constexpr std::size_t kSize = kHugePage / sizeof(T);
  static_assert(kHugePage % sizeof(T) == 0);

  /// The elements of a huge page.
  [[nodiscard]] std::span<T> segment(std::size_t i) const {
    return all_.subspan(i * kSize, std::min(kSize, all_.size() - i * kSize));
  }

  std::span<T> all_;
  std::vector<std::atomic<std::size_t>> used_;  ///< number of elements of each segment
};

}  // namespace microtrace
