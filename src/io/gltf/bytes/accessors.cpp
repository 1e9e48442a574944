#include "io/gltf/bytes/accessors.hpp"

#include "base/memory_account.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>
#include <utility>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

namespace microtrace::io::gltf {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF's numbers are copied as they lie");

template <typename Number>
Number load(const char* bytes) {
  Number value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

std::uint32_t load_unsigned(const char* bytes, int component_type) {
  switch (component_type) {
    case kUint8:
      return load<std::uint8_t>(bytes);
    case kUint16:
      return load<std::uint16_t>(bytes);
    default:
      return load<std::uint32_t>(bytes);
  }
}

/// The component type of an element and its layout in rows and columns. Columns may be padded.
template <typename Element>
struct Parts {
  static constexpr std::size_t kRows = Element::length(), kColumns = 1;
  using Component = typename Element::value_type;
};
template <>
struct Parts<float> {
  static constexpr std::size_t kRows = 1, kColumns = 1;
  using Component = float;
};
template <>
struct Parts<std::uint32_t> {
  static constexpr std::size_t kRows = 1, kColumns = 1;
  using Component = std::uint32_t;
};
template <>
struct Parts<glm::mat4> {
  static constexpr std::size_t kRows = 4, kColumns = 4;  // columns of four bytes need no padding
  using Component = float;
};

template <typename Stored, bool normalized, typename Element>
Element decode_one(const char* bytes) {
  using Component = typename Parts<Element>::Component;
  std::array<Component, Parts<Element>::kRows * Parts<Element>::kColumns> components;
  for (std::size_t i = 0; i < components.size(); ++i) {
    const auto value = static_cast<Component>(load<Stored>(bytes + i * sizeof(Stored)));
    if constexpr (normalized) {
      constexpr auto kGreatest = static_cast<Component>(std::numeric_limits<Stored>::max());
      components[i] = std::max(value / kGreatest, Component(-1));
    } else {
      components[i] = value;
    }
  }
  return std::bit_cast<Element>(components);
}

/// Decodes the elements with the indices `numbers`. If `numbers` is null, decodes the first
/// elements.
template <typename Stored, bool normalized, typename Element>
void decode(const char* bytes, std::size_t stride, const std::uint32_t* numbers,
            std::span<Element> result) {
  for (std::size_t i = 0; i < result.size(); ++i) {
    const std::size_t number = numbers != nullptr ? numbers[i] : i;
    result[i] = decode_one<Stored, normalized, Element>(bytes + number * stride);
  }
}

template <typename Element>
using Decoder = void (*)(const char*, std::size_t, const std::uint32_t*, std::span<Element>);

template <typename Element>
Decoder<Element> decoder(const Model::Accessor& accessor) {
  const int type = accessor.component_type;
  if constexpr (std::is_integral_v<typename Parts<Element>::Component>) {
    if (component_size(type) == 1) return decode<std::uint8_t, false, Element>;
    if (component_size(type) == 2) return decode<std::uint16_t, false, Element>;
    return decode<std::uint32_t, false, Element>;
  } else {
    const auto choose = [&]<typename Stored>(Stored) -> Decoder<Element> {
      return accessor.normalized ? decode<Stored, true, Element> : decode<Stored, false, Element>;
    };
    switch (type) {
      case kInt8:
        return choose(std::int8_t{});
      case kUint8:
        return choose(std::uint8_t{});
      case kInt16:
        return choose(std::int16_t{});
      case kUint16:
        return choose(std::uint16_t{});
      case kUint32:
        return choose(std::uint32_t{});
      default:
        return decode<float, false, Element>;
    }
  }
}

}  // namespace

/// The location of an accessor's elements.
struct AccessorReader::Source {
  const Model::Accessor& accessor;
  std::string_view bytes{};  // starts at the first element; empty without a buffer view
  std::size_t stride = 0, size = 0, count = 0;
  std::string_view sparse_indices{}, sparse_values{};
  std::size_t sparse_count = 0;

  [[nodiscard]] std::uint32_t sparse_index(std::size_t i) const {
    const int type = accessor.sparse->index_type;
    return load_unsigned(&sparse_indices[i * component_size(type)], type);
  }

  /// Returns the number of the first sparse element whose index is at least `index`.
  [[nodiscard]] std::size_t first_sparse(std::uint32_t index) const {
    std::size_t first = 0, last = sparse_count;
    while (first < last) {
      const std::size_t middle = first + (last - first) / 2;
      if (sparse_index(middle) < index) {
        first = middle + 1;
      } else {
        last = middle;
      }
    }
    return first;
  }
};

AccessorReader::AccessorReader(const Asset& asset, const Model& model, const BufferViews& views)
    : asset_(asset), model_(model), views_(views), sparse_is_checked_(model.accessors.size()) {}

bool AccessorReader::has_data(std::size_t index) const {
  if (replaced_.contains(index)) return true;
  const Model::Accessor& accessor = model_.accessors[index];
  const auto& sparse = accessor.sparse;
  return !accessor.is_empty && (!accessor.view || views_.bytes(*accessor.view)) &&
         (!sparse || (views_.bytes(sparse->indices_view) && views_.bytes(sparse->values_view)));
}

std::size_t AccessorReader::count(std::size_t index) const {
  const Model::Accessor& accessor = model_.accessors[index];
  const auto replaced = replaced_.find(index);
  if (replaced == replaced_.end()) return accessor.count;
  return replaced->second.size() / element_size(accessor.type, accessor.component_type);
}

AccessorReader::Source AccessorReader::source(std::size_t index) {
  const Model::Accessor& accessor = model_.accessors[index];
  Source result{.accessor = accessor};
  result.size = element_size(accessor.type, accessor.component_type);
  result.stride = result.size;
  result.count = count(index);
  if (const auto replaced = replaced_.find(index); replaced != replaced_.end()) {
    result.bytes = replaced->second;
    return result;
  }
  if (!accessor.view && accessor.count > kMaxElements) {
    asset_.fail(asset_.element("accessors", index).member("count"),
                "is more than 2^27, the limit for accessors without bufferView", ErrorKind::limit);
  }
  if (accessor.view) {
    result.bytes = views_.bytes(*accessor.view).value().substr(accessor.offset);
    const std::size_t stride = model_.buffer_views[*accessor.view].stride;
    if (stride != 0) result.stride = stride;
  }
  if (const auto& sparse = accessor.sparse) {
    result.sparse_indices =
        views_.bytes(sparse->indices_view).value().substr(sparse->indices_offset);
    result.sparse_values = views_.bytes(sparse->values_view).value().substr(sparse->values_offset);
    result.sparse_count = sparse->count;
    check_sparse(index, result);
  }
  return result;
}

void AccessorReader::check_sparse(std::size_t index, const Source& source) {
  if (sparse_is_checked_[index]) return;
  std::uint64_t least = 0;  // the next index must be at least this number
  for (std::size_t i = 0; i < source.sparse_count; ++i) {
    const std::uint32_t target = source.sparse_index(i);
    if (target < least || target >= source.accessor.count) {
      asset_.fail(asset_.element("accessors", index).member("sparse").member("indices"),
                  "item " + std::to_string(i) + " is " + std::to_string(target) +
                      "; they must ascend and stay below the accessor's count, " +
                      std::to_string(source.accessor.count));
    }
    least = std::uint64_t{target} + 1;
  }
  sparse_is_checked_[index] = true;
}

template <typename Element>
std::vector<Element> AccessorReader::read(std::size_t accessor) {
  const Source from = source(accessor);
  const Decoder<Element> decode_all = decoder<Element>(from.accessor);
  take_memory(from.count * sizeof(Element), "the elements of accessors");
  std::vector<Element> result(from.count, Element(0));
  if (!from.bytes.empty()) decode_all(from.bytes.data(), from.stride, nullptr, result);
  for (std::size_t i = 0; i < from.sparse_count; ++i) {
    const std::span<Element> replaced(&result[from.sparse_index(i)], 1);
    decode_all(&from.sparse_values[i * from.size], 0, nullptr, replaced);
  }
  return result;
}

template <typename Element>
std::vector<Element> AccessorReader::read(std::size_t accessor,
                                          std::span<const std::uint32_t> numbers) {
  const Source from = source(accessor);
  const Decoder<Element> decode_some = decoder<Element>(from.accessor);
  take_memory(numbers.size() * sizeof(Element), "the elements of accessors");
  std::vector<Element> result(numbers.size(), Element(0));
  const auto is_there = [&](std::uint32_t number) { return number < from.count; };
  numbers = numbers.first(
      static_cast<std::size_t>(std::ranges::partition_point(numbers, is_there) - numbers.begin()));
  if (!from.bytes.empty()) {
    // If there are as many distinct indices as elements, they select every element.
    const bool all =
        numbers.size() == from.count && std::ranges::adjacent_find(numbers) == numbers.end();
    decode_some(from.bytes.data(), from.stride, all ? nullptr : numbers.data(),
                std::span(result).first(numbers.size()));
  }
  for (std::size_t i = 0; i < numbers.size() && from.sparse_count > 0; ++i) {
    const std::size_t sparse = from.first_sparse(numbers[i]);
    if (sparse == from.sparse_count || from.sparse_index(sparse) != numbers[i]) continue;
    const std::span<Element> replaced(&result[i], 1);
    decode_some(&from.sparse_values[sparse * from.size], 0, nullptr, replaced);
  }
  return result;
}

template <typename Element>
std::vector<Element> AccessorReader::read_finite(std::size_t accessor,
                                                 std::span<const std::uint32_t> numbers) {
  std::vector<Element> result = read<Element>(accessor, numbers);
  for (Element& element : result) {
    for (glm::length_t i = 0; i < Element::length(); ++i) {
      if (!std::isfinite(element[i])) element[i] = 0;
    }
  }
  return result;
}

void AccessorReader::replace(std::size_t accessor, std::string elements) {
  replaced_[accessor] = std::move(elements);
}

#define MICROTRACE_READ(Element)                                            \
  template std::vector<Element> AccessorReader::read<Element>(std::size_t); \
  template std::vector<Element> AccessorReader::read<Element>(std::size_t,  \
                                                              std::span<const std::uint32_t>);
MICROTRACE_READ(float)
MICROTRACE_READ(glm::vec2)
MICROTRACE_READ(Vec3)
MICROTRACE_READ(glm::vec4)
MICROTRACE_READ(glm::mat4)
MICROTRACE_READ(std::uint32_t)
MICROTRACE_READ(glm::uvec4)
#undef MICROTRACE_READ

#define MICROTRACE_READ_FINITE(Element)                               \
  template std::vector<Element> AccessorReader::read_finite<Element>( \
      std::size_t, std::span<const std::uint32_t>);
MICROTRACE_READ_FINITE(Vec2)
MICROTRACE_READ_FINITE(Vec3)
MICROTRACE_READ_FINITE(Vec4)
#undef MICROTRACE_READ_FINITE

}  // namespace microtrace::io::gltf
