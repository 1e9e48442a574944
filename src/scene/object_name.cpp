#include <microtrace/object_name.hpp>

#include <algorithm>
#include <new>

namespace microtrace {

ObjectName::ObjectName(std::string_view text) {
  if (!text.empty()) *this = ObjectName(text, {}, false);
}

ObjectName::ObjectName(std::string_view head, std::string_view tail, bool is_numbered) {
  void* const memory = ::operator new(sizeof(Text) + head.size() + tail.size());
  Text* const text = ::new (memory) Text{.head = static_cast<std::uint32_t>(head.size()),
                                         .tail = static_cast<std::uint32_t>(tail.size()),
                                         .is_numbered = is_numbered};
  std::ranges::copy(tail, std::ranges::copy(head, reinterpret_cast<char*>(text + 1)).out);
  text_ = SharedHandle<Text>(text);
}

ObjectName ObjectName::numbered(std::string_view head, std::string_view tail) {
  return {head, tail, true};
}

ObjectName ObjectName::with_number(std::uint32_t number) const {
  ObjectName result(*this);
  result.number_ = number;
  return result;
}

std::string ObjectName::str() const {
  if (!text_) return {};
  const Text& text = *text_.operator->();
  const char* const characters = reinterpret_cast<const char*>(&text + 1);
  std::string result(characters, text.head);
  if (text.is_numbered) result += std::to_string(number_);
  return result.append(characters + text.head, text.tail);
}

}  // namespace microtrace
