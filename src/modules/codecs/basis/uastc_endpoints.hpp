#pragma once
/// Reads the endpoint values between which UASTC's weights interpolate.

#include "modules/codecs/basis/bit_reader.hpp"
#include "modules/codecs/basis/uastc_mode.hpp"

#include <array>
#include <cstdint>

namespace basis {

inline constexpr std::size_t kMaxEndpointValues = 18;

/// Reads `count` endpoint values, and converts them to the range 0 to 255. Throws Damage.
[[nodiscard]] std::array<std::uint8_t, kMaxEndpointValues> read_endpoint_values(
    BitReader& bits, const EndpointRange& range, std::size_t count);

}  // namespace basis
