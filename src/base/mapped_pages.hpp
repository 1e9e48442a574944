#pragma once
/// Memory that returns to the system as soon as it is released, unlike that of malloc.

#include <cstddef>

namespace microtrace {

/// Throws std::bad_alloc. The memory is aligned to pages.
[[nodiscard]] void* map_pages(std::size_t bytes);
void unmap_pages(void* p, std::size_t bytes) noexcept;

}  // namespace microtrace
