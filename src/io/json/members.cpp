#include "io/json/members.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <tuple>
#include <utility>

namespace microtrace::io {

std::size_t JsonValue::position(std::string_view key) const {
  if (by_key_) {
    const auto found = std::ranges::lower_bound(
        *by_key_, key, {}, [this](std::uint32_t i) { return std::string_view(members[i].key); });
    const bool is_there = found != by_key_->end() && members[*found].key == key;
    return is_there ? *found : members.size();
  }
  const auto found = std::find_if(members.begin(), members.end(),
                                  [key](const auto& member) { return member.key == key; });
  return static_cast<std::size_t>(found - members.begin());
}

const JsonValue* JsonValue::find(std::string_view key) const {
  const std::size_t i = position(key);
  return i < members.size() ? &members[i].value : nullptr;
}

JsonValue* JsonValue::find(std::string_view key) {
  const std::size_t i = position(key);
  return i < members.size() ? &members[i].value : nullptr;
}

void JsonValue::index_members() {
  constexpr std::size_t kFew = 16;  // for at most this many members, linear search is faster
  by_key_.reset();
  if (members.size() <= kFew) return;
  std::vector<std::uint32_t> order(members.size());
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::sort(order, {},
                    [this](std::uint32_t i) { return std::string_view(members[i].key); });
  by_key_ = std::make_shared<const std::vector<std::uint32_t>>(std::move(order));
}

RepeatedMembers repeated_members(const JsonValue& object) {
  std::vector<std::pair<std::string_view, std::size_t>> keys;
  keys.reserve(object.members.size());
  for (const auto& [name, value] : object.members) keys.emplace_back(name, value.key_offset);
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
