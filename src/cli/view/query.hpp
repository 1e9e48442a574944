#pragma once
/// The part of an address after '?'.

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace microtrace::cli {

/// Members are NAME=VALUE, separated by '&'; escapes are decoded. Each function throws Error
/// (usage) if the member is absent or its value doesn't have the expected form.
class Query {
 public:
  explicit Query(std::string_view text);

  [[nodiscard]] bool has(const std::string& name) const { return values_.contains(name); }
  [[nodiscard]] const std::string& text(const std::string& name) const;
  [[nodiscard]] double number(const std::string& name) const;
  [[nodiscard]] std::uint64_t whole_number(const std::string& name) const;

 private:
  std::map<std::string, std::string> values_;
};

}  // namespace microtrace::cli
