#include "modules/codecs/codecs.hpp"

#include <limits>
#include <zlib.h>

int inflate_raw(void* to, std::size_t size, const void* from, std::size_t compressed) {
  constexpr std::size_t kMost = std::numeric_limits<uInt>::max();
  if (size > kMost || compressed > kMost) return 0;
  z_stream stream{};
  stream.next_in = static_cast<Bytef*>(const_cast<void*>(from));
  stream.avail_in = static_cast<uInt>(compressed);
  stream.next_out = static_cast<Bytef*>(to);
  stream.avail_out = static_cast<uInt>(size);
  if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) return 0;
  const int result = inflate(&stream, Z_FINISH);
  const bool is_whole = result == Z_STREAM_END && stream.avail_in == 0 && stream.avail_out == 0;
  inflateEnd(&stream);
  return is_whole ? 1 : 0;
}
