#include "io/json/value.hpp"

#include <algorithm>
#include <numeric>

namespace microtrace::io {

JsonValue::JsonValue(std::vector<JsonMember> members)
    : content_(Boxed(Members{.list = std::move(members)})) {
  (*std::get<Boxed<Members>>(content_)).index();
}

void JsonValue::Members::index() {
  constexpr std::size_t kFew = 16;  // for at most this many members, linear search is faster
  by_key.clear();
  if (list.size() <= kFew) return;
  by_key.resize(list.size());
  std::iota(by_key.begin(), by_key.end(), 0U);
  std::ranges::sort(by_key, {}, [this](std::uint32_t i) { return std::string_view(list[i].key); });
}

std::size_t JsonValue::position(std::string_view key) const {
  const auto& own = boxed<Members>();
  const std::vector<JsonMember>& list = own.list;
  if (own.by_key.empty()) {
    const auto found = std::ranges::find(list, key, &JsonMember::key);
    return static_cast<std::size_t>(found - list.begin());
  }
  const auto found = std::ranges::lower_bound(
      own.by_key, key, {}, [&list](std::uint32_t i) { return std::string_view(list[i].key); });
  const bool is_there = found != own.by_key.end() && list[*found].key == key;
  return is_there ? *found : list.size();
}

const JsonValue* JsonValue::find(std::string_view key) const {
  const std::vector<JsonMember>& list = members();
  const std::size_t i = position(key);
  return i < list.size() ? &list[i].value : nullptr;
}

JsonValue* JsonValue::find(std::string_view key) {
  const std::size_t i = position(key);
  return i < members().size() ? &(*std::get<Boxed<Members>>(content_)).list[i].value : nullptr;
}

const JsonValue* JsonValue::find(std::size_t index) const {
  return index < items().size() ? &items()[index] : nullptr;
}

JsonValue* JsonValue::find(std::size_t index) {
  return index < items().size() ? &edit_items()[index] : nullptr;
}

std::vector<JsonValue>& JsonValue::edit_items() {
  return *std::get<Boxed<std::vector<JsonValue>>>(content_);
}

void JsonValue::set(JsonValue content) {
  content_ = std::move(content.content_);
}

JsonValue& JsonValue::add(std::string key) {
  Members& members = *std::get<Boxed<Members>>(content_);
  members.list.push_back({.key = std::move(key), .value = {}});
  members.index();
  return members.list.back().value;
}

}  // namespace microtrace::io
