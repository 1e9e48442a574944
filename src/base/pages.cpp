#include "base/mapped_pages.hpp"

#include <microtrace/page_allocator.hpp>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace microtrace {
namespace {

std::align_val_t alignment_of(std::size_t bytes) {
  return std::align_val_t{bytes >= kHugePage ? kHugePage : std::size_t{64}};
}

}  // namespace

void* allocate_pages(std::size_t bytes) {
  if (bytes < kHugePage) return ::operator new(bytes, alignment_of(bytes));
  // A last page that the array fills only in part is a huge page too if it is allocated whole.
  const std::size_t last = bytes % kHugePage,
                    whole = last == 0 ? bytes : bytes + (kHugePage - last);
  if (whole < bytes) throw std::bad_alloc();
  void* const p = ::operator new(whole, alignment_of(whole));
#ifdef __linux__
  madvise(p, whole, MADV_HUGEPAGE);
#endif
  return p;
}

void release_pages(void* p, std::size_t bytes) noexcept {
  ::operator delete(p, alignment_of(bytes));
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

void discard_pages([[maybe_unused]] void* p, [[maybe_unused]] std::size_t bytes) noexcept {
#ifdef __linux__
  if (bytes >= kHugePage) ::madvise(p, bytes, MADV_DONTNEED);
#endif
}

}  // namespace microtrace
