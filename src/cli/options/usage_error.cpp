#include "cli/options/usage_error.hpp"

#include "base/text/nearest_name.hpp"
#include "base/text/printable.hpp"
#include "cli/arguments.hpp"
#include "cli/options/help.hpp"
#include "cli/options/shell_word.hpp"
#include "io/file_name.hpp"

#include <microtrace/error.hpp>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <vector>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

namespace microtrace::cli {
namespace {

std::vector<std::string_view> long_names(Command command) {
  std::vector<std::string_view> long_names;
  for (const OptionGroup& group : option_groups(command)) {
    for (const Option& option : group.options) {
      for (const std::string_view name : option.all_names()) {
        if (name.starts_with("--")) long_names.push_back(name);
      }
    }
  }
  return long_names;
}

std::string unknown_option(Command command, std::string_view argument) {
  const std::string name(argument.substr(0, argument.find('=')));
  std::string message = "unknown option " + printable(name);
  const std::vector<std::string_view> known = long_names(command);
  const std::string spelled = name.starts_with("--") ? name : "-" + name;
  // A letter after one dash is similar to many names.
  const std::string_view nearest = spelled.size() > 3 ? nearest_name(spelled, known) : "";
  if (!nearest.empty()) message.append("; did you mean ").append(nearest).append("?");
  return message;
}

/// Returns true if the option takes this value.
bool accepts(const Option& option, const std::string& value) {
  try {
    Arguments arguments;
    option.set(arguments, {.option = std::string(option.name()), .text = value});
    return true;
  } catch (const Error&) {
    return false;
  }
}

/// Returns true if the name has the extension of a picture. Other formats that --output writes,
/// such as .hdr, are more often those of environments.
bool is_picture(const std::string& name) {
  constexpr std::array<std::string_view, 8> kExtensions = {".exr", ".jpeg", ".jpg",  ".png",
                                                           ".ppm", ".tif",  ".tiff", ".webp"};
  return std::ranges::find(kExtensions, io::lower_case_extension(name)) != kExtensions.end();
}

/// Returns the message for a word that is neither an option nor its value. It may be meant as the
/// value of an option whose value may be omitted, or as the file to write.
std::string unexpected_argument(Command command, const CLI::App& app, const std::string& word) {
  std::string message = "unexpected argument " + in_quotes(word);
  for (const OptionGroup& group : option_groups(command)) {
    for (const Option& option : group.options) {
      if (option.implied_value.empty()) continue;
      const std::string name(option.name());
      const std::vector<std::string>& given = app.get_option(name)->results();
      if (given.empty() || given.back() != option.implied_value || !accepts(option, word)) continue;
      message.append("; the value of ").append(name).append(" follows =, as in ").append(name);
      return message.append("=").append(printable(word));
    }
  }
  // The output of dataset is a folder.
  const CLI::Option* output =
      command == Command::dataset ? nullptr : app.get_option_no_throw("--output");
  if (output != nullptr && output->count() == 0 && is_picture(word))
    message.append("; did you mean --output ").append(shell_word(printable(word))).append("?");
  return message;
}

}  // namespace

std::string message_of(Command command, const CLI::App& app, const CLI::ParseError& error) {
  // CLI11 reports missing arguments before unknown ones, but a mistyped option is often the reason
  // why an argument is missing.
  std::vector<std::string> left = app.remaining();
  const auto is_option = [](const std::string& text) {
    return text.size() > 1 && text[0] == '-' && numbers_of(text).empty();
  };
  const auto mark = std::ranges::find(left, "--");  // what follows is no option
  const auto option = std::find_if(left.begin(), mark, is_option);
  if (option != mark) return unknown_option(command, *option);
  if (mark != left.end()) left.erase(mark);
  if (!left.empty()) return unexpected_argument(command, app, left.front());
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr) {
    const std::string text = error.what();
    const std::string name = text.substr(0, text.find(':'));
    const CLI::Option* known = app.get_option_no_throw(name);
    return name + (known != nullptr && known->count() > 1 ? " is given twice" : " expects a value");
  }
  std::string text = error.what();
  const std::string excludes = " excludes ";
  if (dynamic_cast<const CLI::ExcludesError*>(&error) != nullptr)
    text.replace(text.find(excludes), excludes.size(), " can't be combined with ");
  return printable(text);
}

std::optional<std::string> complaint_about_command(const std::string& word) {
  std::error_code error;
  if (word.starts_with('-') || std::filesystem::exists(word, error)) return std::nullopt;
  std::array<std::string_view, kCommands.size() + 1> names{"completion"};
  std::ranges::transform(kCommands, names.begin() + 1, name_of);
  const std::string_view nearest = nearest_name(word, names);
  if (nearest.empty()) return std::nullopt;
  std::string message = "unknown command " + in_quotes(word);
  if (nearest == name_of(Command::render)) return message + "; to render, name only the scene";
  return message.append("; did you mean ").append(nearest).append("?");
}

int report_usage_error(Command command, const std::string& message) {
  std::fprintf(stderr, "error: %s\nRun %s --help for the options.\n", message.c_str(),
               program_name(command).c_str());
  return static_cast<int>(ErrorKind::usage);
}

}  // namespace microtrace::cli
