#pragma once
#include "io/json/document.hpp"

#include <cstddef>
#include <string_view>
#include <vector>

namespace microtrace::io {

/// Keys of an object that stand more than once, by the bytes at which they start.
struct RepeatedMembers {
  std::vector<std::size_t> outdone{};  ///< those of which a later one has the same name; ascending
  std::size_t first = 0;               ///< the first that has been there before
  std::string_view key{};              ///< its name
};

/// The keys of the object and its `key_offset`s must be there.
[[nodiscard]] RepeatedMembers repeated_members(const JsonValue& object);

}  // namespace microtrace::io
