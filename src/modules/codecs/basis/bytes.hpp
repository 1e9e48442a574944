#pragma once
/// Reads numbers from a file's bytes, with bounds checks.

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>

namespace basis {

/// An error in a file. It is always caught within the module.
class Damage : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

using Bytes = std::span<const unsigned char>;

/// Returns the `size` bytes at `offset`. Throws Damage(words) if `bytes` ends before them.
inline Bytes part_of(Bytes bytes, std::uint64_t offset, std::uint64_t size, const char* words) {
  if (offset > bytes.size() || size > bytes.size() - offset) throw Damage(words);
  return bytes.subspan(static_cast<std::size_t>(offset), static_cast<std::size_t>(size));
}

/// Reads a little-endian number of `size` bytes. Throws Damage.
inline std::uint64_t number_at(Bytes bytes, std::size_t offset, std::size_t size) {
  const Bytes part = part_of(bytes, offset, size, "the file is cut off");
  std::uint64_t result = 0;
  for (std::size_t i = size; i-- > 0;) result = result << 8U | part[i];
  return result;
}

inline std::uint32_t u32_at(Bytes bytes, std::size_t offset) {
  return static_cast<std::uint32_t>(number_at(bytes, offset, 4));
}

}  // namespace basis
