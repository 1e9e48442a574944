#include "io/gltf/check/values/element_bounds.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace microtrace::io::gltf {
namespace {

template <typename Number, std::size_t components>
ElementBounds bounds_of(const Elements& elements) {
  std::array<Number, components> least{}, greatest{}, doubt{};
  least.fill(std::numeric_limits<Number>::max());
  greatest.fill(std::numeric_limits<Number>::lowest());
  for (std::size_t i = 0; i < elements.count(); ++i) {
    const auto element = elements.at<std::array<Number, components>>(i, 0);
    for (std::size_t k = 0; k < components; ++k) {
      least[k] = element[k] < least[k] ? element[k] : least[k];
      greatest[k] = element[k] > greatest[k] ? element[k] : greatest[k];
      // x * 0 is 0 unless x is infinite or NaN.
      if constexpr (std::is_floating_point_v<Number>) doubt[k] += element[k] * Number(0);
    }
  }
  ElementBounds result;
  std::ranges::copy(least, result.least.begin());
  std::ranges::copy(greatest, result.greatest.begin());
  result.all_finite = std::ranges::all_of(doubt, [](Number sum) { return sum == 0; });
  return result;
}

template <typename Number>
ElementBounds bounds_of(const Elements& elements) {
  switch (elements.components()) {
    case 1:
      return bounds_of<Number, 1>(elements);
    case 2:
      return bounds_of<Number, 2>(elements);
    case 3:
      return bounds_of<Number, 3>(elements);
    case 4:
      return bounds_of<Number, 4>(elements);
    case 9:
      return bounds_of<Number, 9>(elements);
    default:
      return bounds_of<Number, 16>(elements);
  }
}

}  // namespace

ElementBounds bounds_of(const Elements& elements) {
  switch (elements.component_type()) {
    case kInt8:
      return bounds_of<std::int8_t>(elements);
    case kUint8:
      return bounds_of<std::uint8_t>(elements);
    case kInt16:
      return bounds_of<std::int16_t>(elements);
    case kUint16:
      return bounds_of<std::uint16_t>(elements);
    case kUint32:
      return bounds_of<std::uint32_t>(elements);
    default:
      return bounds_of<float>(elements);
  }
}

// Infinite numbers and NaN have an exponent of all ones.
bool all_finite(const Elements& elements) {
  constexpr std::uint32_t kExponent = 0x7F800000;
  const std::size_t components = elements.components();
  std::uint32_t bad = 0;
  if (elements.stride() == components * sizeof(float)) {
    for (std::size_t i = 0; i < elements.count() * components; ++i) {
      bad |= (elements.at<std::uint32_t>(0, i) & kExponent) == kExponent ? 1U : 0U;
    }
    return bad == 0;
  }
  for (std::size_t i = 0; i < elements.count(); ++i) {
    for (std::size_t k = 0; k < components; ++k) {
      bad |= (elements.at<std::uint32_t>(i, k) & kExponent) == kExponent ? 1U : 0U;
    }
  }
  return bad == 0;
}

}  // namespace microtrace::io::gltf
