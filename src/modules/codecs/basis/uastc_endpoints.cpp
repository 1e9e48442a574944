#include "modules/codecs/basis/uastc_endpoints.hpp"

#include <algorithm>

namespace basis {
namespace {

/// Trits or quints are stored in groups. Each group is one number whose base-3 or base-5 digits
/// they are. The last group may be shorter.
struct Digits {
  std::size_t group;
  std::array<unsigned, 6> bits;  ///< bits of a group, indexed by its number of digits
};
constexpr Digits kTrits = {5, {0, 2, 4, 5, 7, 8}};
constexpr Digits kQuints = {3, {0, 3, 5, 7}};

/// ASTC's multipliers C for the trit or quint, indexed by the number of bits below it (Khronos Data
/// Format Specification, table "ASTC color unquantization parameters").
constexpr std::array<std::uint32_t, 7> kTritScales = {0, 204, 93, 44, 22, 11, 5};
constexpr std::array<std::uint32_t, 6> kQuintScales = {0, 113, 54, 26, 13, 6};

/// B of the same table: a pattern of nine bits that repeats the bits of the value, except for the
/// lowest.
std::uint32_t repeated_bits(std::uint32_t value, const EndpointRange& range) {
  const std::uint32_t bits = value >> 1U;
  const bool is_trit = range.values == 3;
  switch (range.bits) {
    case 2:
      return is_trit ? bits << 8U | bits << 4U | bits << 2U | bits << 1U
                     : bits << 8U | bits << 3U | bits << 2U;
    case 3:
      return bits << 7U | (is_trit ? bits << 2U | bits : bits << 1U | bits >> 1U);
    case 4:
      return bits << 6U | (is_trit ? bits : bits >> 1U);
    case 5:
      return bits << 5U | (is_trit ? bits >> 2U : bits >> 3U);
    default:  // 6 bits, with a trit; UASTC uses no range with 1 bit
      return bits << 4U | bits >> 4U;
  }
}

/// Converts a quantized endpoint value to 8 bits (ASTC, section "Endpoint Unquantization").
std::uint8_t unquantize(std::uint32_t digit, std::uint32_t value, const EndpointRange& range) {
  if (range.values == 1) {
    std::uint32_t result = value << (8 - range.bits);
    for (unsigned size = range.bits; size < 8; size *= 2) result |= result >> size;
    return static_cast<std::uint8_t>(result);
  }
  const std::uint32_t scale =
      range.values == 3 ? kTritScales[range.bits] : kQuintScales[range.bits];
  const std::uint32_t flip = (value & 1U) != 0 ? 0x1FF : 0;
  const std::uint32_t result = (digit * scale + repeated_bits(value, range)) ^ flip;
  return static_cast<std::uint8_t>((flip & 0x80U) | result >> 2U);
}

}  // namespace

std::array<std::uint8_t, kMaxEndpointValues> read_endpoint_values(BitReader& bits,
                                                                  const EndpointRange& range,
                                                                  std::size_t count) {
  std::array<std::uint32_t, kMaxEndpointValues> digits{};
  if (range.values != 1) {
    const Digits& form = range.values == 3 ? kTrits : kQuints;
    for (std::size_t i = 0; i < count; i += form.group) {
      const std::size_t size = std::min(form.group, count - i);
      std::uint32_t number = bits.read(form.bits[size]);
      for (std::size_t j = 0; j < size; ++j, number /= range.values) {
        digits[i + j] = number % range.values;
      }
    }
  }
  std::array<std::uint8_t, kMaxEndpointValues> result{};
  for (std::size_t i = 0; i < count; ++i) {
    result[i] = unquantize(digits[i], bits.read(range.bits), range);
  }
  return result;
}

}  // namespace basis
