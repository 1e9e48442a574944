#pragma once
/// An allocator for large arrays.

#include <microtrace/export.hpp>

#include <cstddef>
#include <cstring>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace microtrace {

/// Allocate and release memory, aligned to cache lines. Throws std::bad_alloc. Requests huge pages
/// for large arrays: traversal of a large tree would otherwise miss the TLB at every step, and the
/// first writes to a film would take a page fault each 4096 bytes.
[[nodiscard]] MICROTRACE_EXPORT void* allocate_pages(std::size_t bytes);
MICROTRACE_EXPORT void release_pages(void* p, std::size_t bytes) noexcept;
/// Returns true if all bytes that allocate_pages(bytes) returns are 0.
[[nodiscard]] MICROTRACE_EXPORT bool are_zero_pages(std::size_t bytes) noexcept;

/// Uses allocate_pages(). Elements are default-initialized, so resize() leaves plain data
/// uninitialized.
template <class T>
struct PageAllocator {
  using value_type = T;

  PageAllocator() = default;
  template <class U>
  PageAllocator(const PageAllocator<U>&) noexcept {}  // NOLINT(google-explicit-constructor)

  [[nodiscard]] T* allocate(std::size_t n) {
    return static_cast<T*>(allocate_pages(n * sizeof(T)));
  }
  void deallocate(T* p, std::size_t n) noexcept { release_pages(p, n * sizeof(T)); }

  template <class U>
  void construct(U* p) noexcept {
    ::new (static_cast<void*>(p)) U;
  }
  template <class U, class... Args>
  void construct(U* p, Args&&... args) {
    std::construct_at(p, std::forward<Args>(args)...);
  }

  friend bool operator==(const PageAllocator&, const PageAllocator&) { return true; }
};

template <class T>
using PageVector = std::vector<T, PageAllocator<T>>;

/// Returns `count` elements of plain data whose bytes are 0. Avoids writing to large arrays, so
/// that the threads that use them take the page faults.
template <class T>
[[nodiscard]] PageVector<T> zeros(std::size_t count) {
  static_assert(std::is_trivially_copyable_v<T>);
  PageVector<T> result(count);
  const std::size_t bytes = count * sizeof(T);
  if (bytes > 0 && !are_zero_pages(bytes)) std::memset(static_cast<void*>(result.data()), 0, bytes);
  return result;
}

}  // namespace microtrace
