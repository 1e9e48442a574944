#pragma once
/// Divides arrays for tasks of several threads.

#include "accel/build/worker_pool.hpp"

#include <algorithm>
#include <cstddef>
#include <span>

namespace microtrace::build {

/// An array in chunks, which are the same for any number of threads.
template <class T, std::size_t size_of_chunk = std::size_t{1} << 13U>
class Chunks {
 public:
  static constexpr std::size_t kSize = size_of_chunk;

  explicit Chunks(std::span<T> all) : all_(all) {}
  [[nodiscard]] std::size_t size() const { return (all_.size() + kSize - 1) / kSize; }
  [[nodiscard]] std::span<T> operator[](std::size_t i) const {
    return all_.subspan(i * kSize, std::min(kSize, all_.size() - i * kSize));
  }

 private:
  std::span<T> all_;
};

/// Calls f(chunk) for each chunk of an array, on all threads.
template <class T, class F>
void for_each_chunk(std::span<T> all, WorkerPool& pool, const F& f) {
  const Chunks<T> chunks(all);
  pool.run(chunks.size(), [&](std::size_t i) { f(chunks[i]); });
}

}  // namespace microtrace::build
