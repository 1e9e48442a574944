#pragma once
#include <cstdint>
#include <string_view>

namespace microtrace {

/// Returns the checksum of ZIP archives, CRC-32 (ISO/IEC 13239).
[[nodiscard]] std::uint32_t crc32(std::string_view bytes);

}  // namespace microtrace
