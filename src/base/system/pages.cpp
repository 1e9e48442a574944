#include "base/system/mapped_pages.hpp"

#include <microtrace/page_allocator.hpp>

#include <cstdint>
#include <limits>

#ifdef __linux__
#include <sys/mman.h>
#endif
#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace microtrace {
namespace {

#ifdef __linux__
std::size_t whole_pages(std::size_t bytes) {
  if (bytes > std::numeric_limits<std::size_t>::max() - 2 * kHugePage) throw std::bad_alloc();
  return (bytes + kHugePage - 1) / kHugePage * kHugePage;
}
#endif

}  // namespace

void* allocate_pages(std::size_t bytes) {
  if (bytes < kHugePage) return ::operator new (bytes, std::align_val_t{64});
#ifdef __linux__
  // Maps more, to cut out a range that begins at a huge page. A last page that the array fills only
  // in part is a huge page too if it is mapped whole.
  const std::size_t whole = whole_pages(bytes), more = whole + kHugePage;
  auto* const p = static_cast<std::byte*>(map_pages(more));
  const std::size_t before = -reinterpret_cast<std::uintptr_t>(p) % kHugePage;
  if (before > 0) unmap_pages(p, before);
  if (before < kHugePage) unmap_pages(p + before + whole, kHugePage - before);
  madvise(p + before, whole, MADV_HUGEPAGE);
  return p + before;
#else
  return ::operator new (bytes, std::align_val_t{kHugePage});
#endif
}

void release_pages(void* p, std::size_t bytes) noexcept {
  if (bytes < kHugePage) return ::operator delete (p, std::align_val_t{64});
#ifdef __linux__
  unmap_pages(p, whole_pages(bytes));
#else
  ::operator delete (p, std::align_val_t{kHugePage});
#endif
}

bool are_zero_pages([[maybe_unused]] std::size_t bytes) noexcept {
#ifdef __linux__
  return bytes >= kHugePage;  // the kernel clears mapped pages
#else
  return false;
#endif
}

void* map_pages(std::size_t bytes) {
#ifdef __linux__
  void* const p =
      ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (p == MAP_FAILED) throw std::bad_alloc();
  return p;
#else
  return allocate_pages(bytes);
#endif
}

void unmap_pages(void* p, std::size_t bytes) noexcept {
#ifdef __linux__
  ::munmap(p, bytes);
#else
  release_pages(p, bytes);
#endif
}

bool can_map_pages(std::size_t bytes) noexcept {
  try {
    unmap_pages(map_pages(bytes), bytes);
    return true;
  } catch (const std::bad_alloc&) {
    return false;
  }
}

void discard_pages([[maybe_unused]] void* p, [[maybe_unused]] std::size_t bytes) noexcept {
#ifdef __linux__
  if (bytes >= kHugePage) ::madvise(p, bytes, MADV_DONTNEED);
#endif
}

void trim_heap() noexcept {
#ifdef __GLIBC__
  ::malloc_trim(0);
#endif
}

}  // namespace microtrace
