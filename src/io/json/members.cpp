#include "io/json/members.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <tuple>
#include <utility>

namespace microtrace::io {

RepeatedMembers repeated_members(std::span<const JsonMember> members) {
  std::vector<std::pair<std::string_view, std::size_t>> keys;
  keys.reserve(members.size());
  for (const auto& [name, value] : members) keys.emplace_back(name, value.key_offset);
  std::sort(keys.begin(), keys.end());
  RepeatedMembers result;
  for (std::size_t i = 1; i < keys.size(); ++i) {
    if (keys[i].first != keys[i - 1].first) continue;
    if (result.outdone.empty() || keys[i].second < result.first)
      std::tie(result.key, result.first) = keys[i];
    result.outdone.push_back(keys[i - 1].second);
  }
  std::sort(result.outdone.begin(), result.outdone.end());
  return result;
}

}  // namespace microtrace::io
