#pragma once
/// Writes JSON texts member by member.

#include "io/json/write.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace microtrace::dataset {

/// An object or array under construction.
class JsonText {
 public:
  explicit JsonText(char opening) : text_(1, opening) {}

  /// Begins a member. A value must follow.
  JsonText& key(std::string_view name) {
    separate();
    io::append_json(text_, name);
    text_ += ':';
    return *this;
  }
  /// Adds a member.
  template <class Value>
  JsonText& member(std::string_view name, const Value& value) {
    key(name);
    append(value);
    return *this;
  }
  /// Adds an element of an array.
  template <class Value>
  JsonText& item(const Value& value) {
    separate();
    append(value);
    return *this;
  }
  /// Adds an element that is given as JSON text.
  JsonText& json_item(std::string_view json) {
    separate();
    text_ += json;
    return *this;
  }
  /// Adds a member whose value is given as JSON text.
  JsonText& json_member(std::string_view name, std::string_view json) {
    key(name);
    text_ += json;
    return *this;
  }

  /// Returns the text, with the closing bracket.
  [[nodiscard]] std::string text() const { return text_ + (text_[0] == '{' ? '}' : ']'); }

 private:
  void separate() {
    if (text_.size() > 1) text_ += ',';
  }
  void append(std::string_view value) { io::append_json(text_, value); }
  void append(const std::string& value) { io::append_json(text_, value); }
  void append(double value) { io::append_json(text_, value); }
  void append(std::uint64_t value) { text_ += std::to_string(value); }
  void append(std::uint32_t value) { text_ += std::to_string(value); }
  void append(int value) { text_ += std::to_string(value); }

  std::string text_;
};

/// Returns a JSON array of numbers.
template <class Numbers>
[[nodiscard]] std::string json_array(const Numbers& numbers) {
  JsonText array('[');
  for (const auto& number : numbers) array.item(number);
  return array.text();
}

}  // namespace microtrace::dataset
