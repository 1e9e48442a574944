#pragma once
/// A JSON value for building and editing test input.

#include <cstddef>
#include <functional>
#include <initializer_list>
#include <iosfwd>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace microtrace::tests {

/// Behaves like nlohmann::json as far as tests need it, but without templates, which would take
/// seconds of compile time in every file.
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
  /// An object if every value is an array of a string and a value, otherwise an array.
  Json(std::initializer_list<Json> values);
  Json(const Json&);
  Json(Json&&) noexcept;
  Json& operator=(const Json&);
  Json& operator=(Json&&) noexcept;
  ~Json();

  [[nodiscard]] static Json array(std::initializer_list<Json> values = {});
  [[nodiscard]] static Json object();
  /// An array of equal values.
  [[nodiscard]] static Json repeated(std::size_t count, const Json& value);
  /// Throws nlohmann's exceptions.
  [[nodiscard]] static Json parse(std::string_view text);

  /// The element with this index or key, created as null if absent. References to an object's
  /// elements stay valid when elements are added.
  Json& operator[](std::size_t index);
  Json& operator[](std::string_view key);
  void push_back(const Json& value);
  void erase(std::size_t index);
  void erase(std::string_view key);
  /// Sets the members of another object.
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

  /// The JSON text: on one line, or with a line for each value if there is an indentation.
  [[nodiscard]] std::string dump(int indentation = -1) const;
  friend std::ostream& operator<<(std::ostream& out, const Json& json);

 private:
  enum class Kind { scalar, array, object };

  explicit Json(Kind kind);
  [[nodiscard]] bool is_null() const;
  void append_to(std::string& text) const;

  Kind kind_ = Kind::scalar;
  std::string scalar_;  // its JSON text
  std::vector<Json> elements_;
  std::map<std::string, Json, std::less<>> members_;
};

}  // namespace microtrace::tests
