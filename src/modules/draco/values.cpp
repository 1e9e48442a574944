#include "modules/draco/values.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <draco/attributes/attribute_octahedron_transform.h>
#include <draco/attributes/attribute_quantization_transform.h>

namespace {

constexpr std::uint32_t kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123,
                        kUnsignedInt = 5125, kFloat = 5126;
constexpr const char* kUnreadable = "an attribute can't be read as its accessor's type";

draco::AttributeValueIndex value_index(const draco::PointAttribute& source, std::size_t point) {
  return source.mapped_index(draco::PointIndex(static_cast<std::uint32_t>(point)));
}

/// Copies values that are not quantized.
template <typename Number>
const char* write_plain(const draco::PointAttribute& source, std::size_t points,
                        const MicrotraceDracoAttribute& wanted) {
  auto* out = static_cast<char*>(wanted.values);
  std::array<Number, 4> element{};
  for (std::size_t i = 0; i < points; ++i) {
    const draco::AttributeValueIndex index = value_index(source, i);
    if (index.value() >= source.size() ||
        !source.ConvertValue(index, static_cast<std::int8_t>(wanted.components), element.data()))
      return kUnreadable;
    std::memcpy(out, element.data(), sizeof(Number) * wanted.components);
    out += sizeof(Number) * wanted.components;
  }
  return nullptr;
}

/// Calls restore(integers, floats) with the stored integers of each element, and writes the
/// resulting floats.
template <typename Restore>
const char* write_restored(const draco::PointAttribute& source, std::size_t points,
                           const MicrotraceDracoAttribute& wanted, std::uint32_t stored,
                           Restore&& restore) {
  if (wanted.type != kFloat || source.num_components() != stored) return kUnreadable;
  auto* out = static_cast<char*>(wanted.values);
  std::array<std::int32_t, 4> integers{};
  std::array<float, 4> floats{};
  for (std::size_t i = 0; i < points; ++i) {
    const draco::AttributeValueIndex index = value_index(source, i);
    if (index.value() >= source.size() ||
        !source.ConvertValue(index, static_cast<std::int8_t>(stored), integers.data()))
      return kUnreadable;
    restore(integers, floats);
    std::memcpy(out, floats.data(), sizeof(float) * wanted.components);
    out += sizeof(float) * wanted.components;
  }
  return nullptr;
}

const char* write_quantized(const draco::PointAttribute& source, std::size_t points,
                            const MicrotraceDracoAttribute& wanted) {
  draco::AttributeQuantizationTransform transform;
  if (!transform.InitFromAttribute(source)) return kUnreadable;
  const int bits = transform.quantization_bits();
  const std::vector<float>& least = transform.min_values();
  if (bits < 1 || bits > 30 || least.size() < wanted.components) return kUnreadable;
  const float step = transform.range() / static_cast<float>((1U << bits) - 1);
  return write_restored(source, points, wanted, wanted.components,
                        [&](const auto& integers, auto& floats) {
                          for (std::size_t k = 0; k < wanted.components; ++k) {
                            floats[k] = static_cast<float>(integers[k]) * step + least[k];
                          }
                        });
}

/// Writes unit vectors in octahedral encoding. Each coordinate of the unfolded octahedron is
/// quantized to 2^bits - 1 steps.
const char* write_octahedral(const draco::PointAttribute& source, std::size_t points,
                             const MicrotraceDracoAttribute& wanted) {
  draco::AttributeOctahedronTransform transform;
  if (!transform.InitFromAttribute(source)) return kUnreadable;
  const int bits = transform.quantization_bits();
  if (bits < 2 || bits > 30 || wanted.components != 3) return kUnreadable;
  const float step = 2 / static_cast<float>((1U << bits) - 2);
  return write_restored(source, points, wanted, 2, [step](const auto& integers, auto& floats) {
    float y = static_cast<float>(integers[0]) * step - 1;
    float z = static_cast<float>(integers[1]) * step - 1;
    const float x = 1 - std::abs(y) - std::abs(z);
    const float fold = x < 0 ? -x : 0;
    y += y < 0 ? fold : -fold;
    z += z < 0 ? fold : -fold;
    const float square = x * x + y * y + z * z;
    const float scale = square > 0 ? 1 / std::sqrt(square) : 0;
    floats = {x * scale, y * scale, z * scale, 0};
  });
}

}  // namespace

const char* write_draco_values(const draco::PointAttribute& source, std::size_t points,
                               const MicrotraceDracoAttribute& wanted) {
  if (const draco::AttributeTransformData* transform = source.GetAttributeTransformData()) {
    if (transform->transform_type() == draco::ATTRIBUTE_QUANTIZATION_TRANSFORM)
      return write_quantized(source, points, wanted);
    if (transform->transform_type() == draco::ATTRIBUTE_OCTAHEDRON_TRANSFORM)
      return write_octahedral(source, points, wanted);
  }
  if (source.num_components() != wanted.components) return kUnreadable;
  switch (wanted.type) {
    case kByte:
      return write_plain<std::int8_t>(source, points, wanted);
    case kUnsignedByte:
      return write_plain<std::uint8_t>(source, points, wanted);
    case kShort:
      return write_plain<std::int16_t>(source, points, wanted);
    case kUnsignedShort:
      return write_plain<std::uint16_t>(source, points, wanted);
    case kUnsignedInt:
      return write_plain<std::uint32_t>(source, points, wanted);
    case kFloat:
      return write_plain<float>(source, points, wanted);
    default:
      return kUnreadable;
  }
}
