#pragma once
/// Counts the memory of JSON values before it is allocated.

#include "base/memory_account.hpp"
#include "io/json/value.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace microtrace::io {

class TreeMemory {
 public:
  /// Counts an element of an array without its content.
  void take_item() { take(kBytesOfItem); }
  /// Counts a member without its value's content, and its place in the index of large objects.
  void take_member(std::size_t key_size) { take(bytes_of_member(key_size)); }
  /// Counts the content of a string value.
  void take_boxed(std::size_t size) { take(bytes_of_boxed(size)); }
  /// Counts the content of an array or object without its elements or members.
  void take_container() { take(kBytesOfContainer); }

  /// The bytes that are counted for a member with its value.
  [[nodiscard]] static std::uint64_t bytes_of(const JsonMember& member) {
    return bytes_of_member(member.key.size()) + bytes_of_content(member.value);
  }

  /// Adds an element to a stack. A stack that is full doubles, and the old one is freed afterwards.
  template <class T>
  void push(std::vector<T>& stack, T value) {
    if (stack.size() == stack.capacity())
      take(3 * std::max<std::size_t>(stack.size(), 1) * sizeof(T) / 2);
    stack.push_back(std::move(value));
  }

 private:
  /// What an allocation needs beside its content.
  static constexpr std::size_t kBytesOfAllocation = 16;
  static constexpr std::size_t kBytesOfItem = sizeof(JsonValue);
  /// An object has two vectors.
  static constexpr std::size_t kBytesOfContainer =
      2 * sizeof(std::vector<JsonValue>) + 2 * kBytesOfAllocation;

  static std::size_t bytes_of_member(std::size_t key_size) {
    return sizeof(JsonMember) + sizeof(std::uint32_t) + bytes_beside(key_size);
  }
  static std::size_t bytes_of_boxed(std::size_t size) {
    return sizeof(std::string) + kBytesOfAllocation + bytes_beside(size);
  }
  static std::uint64_t bytes_of_content(const JsonValue& value) {
    std::uint64_t result = 0;
    if (value.kind() == JsonValue::Kind::string) result += bytes_of_boxed(value.string().size());
    if (value.kind() == JsonValue::Kind::array || value.kind() == JsonValue::Kind::object)
      result += kBytesOfContainer;
    for (const JsonValue& item : value.items()) result += kBytesOfItem + bytes_of_content(item);
    for (const JsonMember& member : value.members()) result += bytes_of(member);
    return result;
  }

  static std::size_t bytes_beside(std::size_t size) {
    constexpr std::size_t kMostInPlace = 15;
    return size > kMostInPlace ? size + 1 + kBytesOfAllocation : 0;
  }

  void take(std::size_t bytes) {
    constexpr std::size_t kBlock = std::size_t{1} << 16U;
    if (bytes > left_) {
      const std::size_t taken = std::max(kBlock, bytes);
      take_memory(taken, "the values of JSON");
      left_ += taken;
    }
    left_ -= bytes;
  }

  std::size_t left_ = 0;  // bytes that are counted but not allocated yet
};

/// The temporary memory for finding the repeated ones of so many keys. Few need no account.
[[nodiscard]] inline MemoryAccount memory_of_keys(std::size_t count) {
  constexpr std::size_t kFew = 1024;
  if (count <= kFew) return MemoryAccount(nullptr);
  return temporary_memory(count * sizeof(std::pair<std::string_view, std::size_t>),
                          "the keys of JSON");
}

}  // namespace microtrace::io
