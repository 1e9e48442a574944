#pragma once
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>

namespace microtrace {

/// Appends an unsigned integer, lowest byte first.
template <std::unsigned_integral Number>
void append_little(std::string& bytes, Number number) {
  for (std::size_t i = 0; i < sizeof(Number); ++i)
    bytes += static_cast<char>(static_cast<std::uint64_t>(number) >> 8 * i & 0xFF);
}

inline void append_little(std::string& bytes, float number) {
  append_little(bytes, std::bit_cast<std::uint32_t>(number));
}

}  // namespace microtrace
