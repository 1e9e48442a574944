#pragma once
/// A JSON value with its position in the text.

#include "io/json/boxed.hpp"

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace microtrace::io {

struct JsonMember;

/// A file may have millions of values, so they are small.
class JsonValue {
 public:
  enum class Kind : std::uint8_t { null, boolean, number, string, array, object };

  JsonValue() noexcept;
  explicit JsonValue(std::same_as<bool> auto boolean) : content_(boolean) {}
  explicit JsonValue(double finite);
  explicit JsonValue(std::string string);
  explicit JsonValue(std::vector<JsonValue> items);
  /// Makes an object. The keys must be unique.
  explicit JsonValue(std::vector<JsonMember> members);
  JsonValue(const JsonValue& other);
  JsonValue(JsonValue&& other) noexcept;
  JsonValue& operator=(const JsonValue& other);
  JsonValue& operator=(JsonValue&& other) noexcept;
  ~JsonValue();

  [[nodiscard]] Kind kind() const { return static_cast<Kind>(content_.index()); }
  /// Returns false for values of other kinds.
  [[nodiscard]] bool boolean() const;
  /// Returns 0 for values of other kinds. Always finite.
  [[nodiscard]] double number() const;
  /// Returns an empty string for values of other kinds.
  [[nodiscard]] const std::string& string() const;
  /// Returns the elements of an array. Values of other kinds have none.
  [[nodiscard]] const std::vector<JsonValue>& items() const;
  /// Returns the members of an object, in file order. Values of other kinds have none.
  [[nodiscard]] const std::vector<JsonMember>& members() const;

  /// The member with this name, or null.
  [[nodiscard]] const JsonValue* find(std::string_view key) const;
  [[nodiscard]] JsonValue* find(std::string_view key);
  /// The element with this index, or null.
  [[nodiscard]] const JsonValue* find(std::size_t index) const;
  [[nodiscard]] JsonValue* find(std::size_t index);

  /// Returns the elements of this value, which must be an array.
  [[nodiscard]] std::vector<JsonValue>& edit_items();
  /// Replaces the content and keeps the position.
  void set(JsonValue content);
  /// Adds a member to this value, which must be an object without such a member. Returns its value.
  JsonValue& add(std::string key);
  /// Removes the members whose keys satisfy `is_removed` from this value, which must be an object,
  /// and releases their memory.
  template <class Predicate>
  void remove_members(const Predicate& is_removed);

  std::uint32_t offset = 0;      ///< byte offset of the value
  std::uint32_t key_offset = 0;  ///< byte offset of the value's key, if it is a member

 private:
  struct Members;

  /// Returns the content of type T. Returns T{} for values of other kinds.
  template <class T>
  [[nodiscard]] const T& boxed() const;
  /// Returns the index of the member with this name. Equal to the number of members if it is
  /// absent.
  [[nodiscard]] std::size_t position(std::string_view key) const;

  std::variant<std::monostate, bool, double, Boxed<std::string>, Boxed<std::vector<JsonValue>>,
               Boxed<Members>>
      content_;  // in the order of Kind
};

struct JsonMember {
  std::string key;
  JsonValue value;
};

struct JsonValue::Members {
  std::vector<JsonMember> list{};
  std::vector<std::uint32_t> by_key{};  ///< indices sorted by key; empty if there are few members

  /// Must be called after members were added or removed.
  void index();
};

static_assert(sizeof(JsonValue) == 24);

inline JsonValue::JsonValue() noexcept = default;
inline JsonValue::JsonValue(double finite) : content_(finite) {}
inline JsonValue::JsonValue(std::string string) : content_(Boxed(std::move(string))) {}
inline JsonValue::JsonValue(std::vector<JsonValue> items) : content_(Boxed(std::move(items))) {}
inline JsonValue::JsonValue(const JsonValue& other) = default;
inline JsonValue::JsonValue(JsonValue&& other) noexcept = default;
inline JsonValue& JsonValue::operator=(const JsonValue& other) = default;
inline JsonValue& JsonValue::operator=(JsonValue&& other) noexcept = default;
inline JsonValue::~JsonValue() = default;

inline bool JsonValue::boolean() const {
  const bool* value = std::get_if<bool>(&content_);
  return value != nullptr && *value;
}

inline double JsonValue::number() const {
  const double* value = std::get_if<double>(&content_);
  return value != nullptr ? *value : 0;
}

template <class T>
const T& JsonValue::boxed() const {
  if (const Boxed<T>* box = std::get_if<Boxed<T>>(&content_)) return **box;
  static const T none{};
  return none;
}

inline const std::string& JsonValue::string() const {
  return boxed<std::string>();
}

inline const std::vector<JsonValue>& JsonValue::items() const {
  return boxed<std::vector<JsonValue>>();
}

inline const std::vector<JsonMember>& JsonValue::members() const {
  return boxed<Members>().list;
}

template <class Predicate>
void JsonValue::remove_members(const Predicate& is_removed) {
  Members& members = *std::get<Boxed<Members>>(content_);
  const auto is_removed_member = [&](const JsonMember& member) { return is_removed(member.key); };
  if (std::erase_if(members.list, is_removed_member) == 0) return;
  members.list.shrink_to_fit();
  members.index();
}

}  // namespace microtrace::io
