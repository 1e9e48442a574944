#include "cli/view/query.hpp"

#include "cli/options/option_value.hpp"

#include <charconv>
#include <cstddef>

namespace microtrace::cli {
namespace {

std::string decoded(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned value = 0;
    const char* digits = text.data() + i + 1;
    if (text[i] == '%' && i + 2 < text.size() &&
        std::from_chars(digits, digits + 2, value, 16).ptr == digits + 2) {
      result += static_cast<char>(value);
      i += 2;
    } else {
      result += text[i] == '+' ? ' ' : text[i];
    }
  }
  return result;
}

}  // namespace

Query::Query(std::string_view text) {
  while (!text.empty()) {
    const std::string_view member = text.substr(0, text.find('&'));
    text.remove_prefix(std::min(text.size(), member.size() + 1));
    const std::size_t equals = std::min(member.find('='), member.size());
    const std::size_t value = std::min(equals + 1, member.size());
    values_.emplace(decoded(member.substr(0, equals)), decoded(member.substr(value)));
  }
}

const std::string& Query::text(const std::string& name) const {
  const auto found = values_.find(name);
  if (found == values_.end()) refuse_usage("the address lacks " + name + "=");
  return found->second;
}

double Query::number(const std::string& name) const {
  return OptionValue{.option = name, .text = text(name)}.number();
}

std::uint64_t Query::whole_number(const std::string& name) const {
  const std::string& value = text(name);
  std::uint64_t number = 0;
  const char* end = value.data() + value.size();
  const auto [rest, error] = std::from_chars(value.data(), end, number);
  if (error != std::errc() || rest != end || value.empty())
    refuse_usage(name + ": must be a whole number");
  return number;
}

}  // namespace microtrace::cli
