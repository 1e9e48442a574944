#pragma once
/// Memory that returns to the system as soon as it is released, unlike that of malloc.

#include <cstddef>

namespace microtrace {

inline constexpr std::size_t kHugePage = std::size_t{1} << 21U;

/// Throws std::bad_alloc. The memory is aligned to pages.
[[nodiscard]] void* map_pages(std::size_t bytes);
void unmap_pages(void* p, std::size_t bytes) noexcept;

/// Returns true if map_pages() would succeed now.
[[nodiscard]] bool can_map_pages(std::size_t bytes) noexcept;

/// Returns memory of allocate_pages() to the system, whose contents are lost. It may be used again,
/// and must be released as before. p is the beginning of a page.
void discard_pages(void* p, std::size_t bytes) noexcept;

/// Returns pages of malloc() that contain only freed memory to the system. Useful after many small
/// allocations were freed.
void trim_heap() noexcept;

}  // namespace microtrace
