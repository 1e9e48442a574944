#include "io/gltf/check/schema/rule_text.hpp"

#include "base/text/printable.hpp"

#include <cmath>
#include <sstream>

namespace microtrace::io::gltf {
namespace {

template <typename Values, typename Text>
std::string listed(const Values& values, Text&& text) {
  std::string result;
  for (const auto& value : values) {
    if (!result.empty()) result += ", ";
    result += text(value);
  }
  return result;
}

}  // namespace

std::string text_of(double number) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.precision(17);
  text << number;
  return text.str();
}

std::string values_of(const Rule& rule) {
  return rule.values.empty() ? listed(rule.strings, in_quotes) : listed(rule.values, text_of);
}

std::string range_of(const Rule& rule) {
  std::string result;
  if (std::isfinite(rule.min)) {
    result += (rule.above_min ? " above " : " of at least ") + text_of(rule.min);
  }
  if (std::isfinite(rule.max)) {
    result += (result.empty() ? " of" : " and") + std::string(" at most ") + text_of(rule.max);
  }
  return result;
}

}  // namespace microtrace::io::gltf
