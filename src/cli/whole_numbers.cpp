#include "cli/whole_numbers.hpp"

#include "base/printable.hpp"
#include "cli/option_values.hpp"

#include <optional>
#include <string>

namespace microtrace::cli {

CLI::Validator whole_number_between(std::uint32_t least, std::uint32_t most) {
  const auto make_decimal = [least, most](std::string& text) -> std::string {
    const std::optional<std::uint32_t> number = whole_number(text);
    if (!number || *number < least || *number > most) {
      return "must be a whole number from " + std::to_string(least) + " to " +
             std::to_string(most) + ", is " + in_quotes(text);
    }
    text = std::to_string(*number);
    return {};
  };
  return {make_decimal, "", ""};
}

}  // namespace microtrace::cli
