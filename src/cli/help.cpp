#include "cli/help.hpp"

#include <memory>
#include <sstream>
#include <string>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

namespace microtrace::cli {
namespace {

constexpr std::size_t kLeft = 27, kRight = 72;  // columns of names, and of what they mean

std::string wrapped(const std::string& text) {
  std::istringstream words(text);
  std::string result;
  std::size_t length = 0;
  for (std::string word; words >> word;) {
    const bool breaks = length > 0 && length + 1 + word.size() > kRight;
    if (length > 0) result += breaks ? '\n' : ' ';
    length = (breaks || length == 0 ? 0 : length + 1) + word.size();
    result += word;
  }
  return result;
}

class HelpFormat : public CLI::Formatter {
 public:
  HelpFormat() { column_width(kLeft); }

  std::string make_option_desc(const CLI::Option* option) const override {
    return wrapped(option->get_description());
  }

  std::string make_option_opts(const CLI::Option* option) const override {
    return option->get_type_size() == 0 ? "" : " " + value_name(*option);
  }
};

}  // namespace

void set_help_format(CLI::App& app) {
  app.formatter(std::make_shared<HelpFormat>());
}

std::string value_name(const CLI::Option& option) {
  const std::string kind = option.get_type_name();
  return kind.substr(0, kind.find(':'));
}

}  // namespace microtrace::cli
