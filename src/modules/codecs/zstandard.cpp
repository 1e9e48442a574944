#include "modules/codecs/codecs.hpp"

#include <zstd.h>

std::size_t compress(void* to, std::size_t capacity, const void* from, std::size_t size) {
  constexpr int kLevel = 1;
  const std::size_t compressed = ZSTD_compress(to, capacity, from, size, kLevel);
  return ZSTD_isError(compressed) != 0U ? 0 : compressed;
}

int decompress(void* to, std::size_t size, const void* from, std::size_t compressed) {
  return ZSTD_decompress(to, size, from, compressed) == size ? 1 : 0;
}
