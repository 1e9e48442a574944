#pragma once
/// JSON values for building and editing test input.

#include <cstddef>
#include <functional>
#include <initializer_list>
#include <iosfwd>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace microtrace::tests {

/// Offers the part of nlohmann::json's interface that tests need, without templates. Templates
/// would take seconds of compile time in every file.
class Json {
 public:
  Json();  // null
  Json(bool value);
  Json(int value);
  Json(unsigned value);
  Json(long value);
  Json(unsigned long value);
  Json(double value);
  Json(const char* value);
  Json(const std::string& value);
  /// Makes an object if every value is an array of a string and a value. Otherwise makes an array.
  Json(std::initializer_list<Json> values);
  Json(const Json&);
  Json(Json&&) noexcept;
  Json& operator=(const Json&);
  Json& operator=(Json&&) noexcept;
  ~Json();

  [[nodiscard]] static Json array(std::initializer_list<Json> values = {});
  [[nodiscard]] static Json object();
  /// Returns an array of `count` equal values.
  [[nodiscard]] static Json repeated(std::size_t count, const Json& value);
  /// Throws the same exceptions as nlohmann::json.
  [[nodiscard]] static Json parse(std::string_view text);

  /// The element with this index or key. If it is absent, it is created as null. Adding elements to
  /// an object does not invalidate references to its elements.
  Json& operator[](std::size_t index);
  Json& operator[](std::string_view key);
  void push_back(const Json& value);
  void erase(std::size_t index);
  void erase(std::string_view key);
  /// Sets the members of another object in this one.
  void update(const Json& other);
  /// Applies a merge patch (RFC 7396).
  void merge_patch(const Json& patch);

  [[nodiscard]] bool contains(std::string_view key) const;
  [[nodiscard]] std::size_t size() const;
  /// The members of an object.
  [[nodiscard]] const std::map<std::string, Json, std::less<>>& members() const;
  /// The elements of an array.
  [[nodiscard]] std::vector<Json>::iterator begin();
  [[nodiscard]] std::vector<Json>::iterator end();
  [[nodiscard]] std::size_t to_size() const;
  [[nodiscard]] bool operator==(const Json& other) const;

  /// Returns the JSON text, on one line if `indentation` is negative. Otherwise each value has a
  /// line of its own.
  [[nodiscard]] std::string dump(int indentation = -1) const;
  friend std::ostream& operator<<(std::ostream& out, const Json& json);

 private:
  enum class Kind { scalar, array, object };

  explicit Json(Kind kind);
  [[nodiscard]] bool is_null() const;
  void append_to(std::string& text) const;

  Kind kind_ = Kind::scalar;
  std::string scalar_;  // JSON text of the value
  std::vector<Json> elements_;
  std::map<std::string, Json, std::less<>> members_;
};

}  // namespace microtrace::tests
