#pragma once
/// An allocator for large arrays.

#include <microtrace/export.hpp>

#include <cstddef>
#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace microtrace {

/// Allocate and release memory, aligned to cache lines. Throws std::bad_alloc. Requests huge pages
/// for large arrays: traversal of a large tree would otherwise miss the TLB at every step, and the
/// first writes to a film would take a page fault each 4096 bytes.
[[nodiscard]] MICROTRACE_EXPORT void* allocate_pages(std::size_t bytes);
MICROTRACE_EXPORT void release_pages(void* p, std::size_t bytes) noexcept;

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

}  // namespace microtrace
