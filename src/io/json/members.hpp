#pragma once
#include "io/json/value.hpp"

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

namespace microtrace::io {

/// The duplicate keys of an object, as byte offsets.
struct RepeatedMembers {
  std::vector<std::size_t> outdone{};  ///< keys that are repeated later; ascending
  std::size_t first = 0;               ///< the first key that repeats an earlier one
  std::string_view key{};              ///< the name of this key
};

/// Finds duplicate keys. The `key_offset` of each member must be set.
[[nodiscard]] RepeatedMembers repeated_members(std::span<const JsonMember> members);

}  // namespace microtrace::io
