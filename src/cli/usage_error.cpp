#include "cli/usage_error.hpp"

#include "base/nearest_name.hpp"
#include "base/printable.hpp"

#include <microtrace/error.hpp>

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

namespace microtrace::cli {
namespace {

std::vector<std::string> long_options(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

std::string unknown_option(const CLI::App& app, std::string_view argument) {
  const std::string name(argument.substr(0, argument.find('=')));
  std::string message = "unknown option " + printable(name);
  if (!name.starts_with("--")) return message;
  const std::vector<std::string> names = long_options(app);
  const std::vector<std::string_view> known(names.begin(), names.end());
  const std::string_view nearest = nearest_name(name, known);
  if (!nearest.empty()) message.append("; did you mean ").append(nearest).append("?");
  return message;
}

std::string message_of(const CLI::App& app, const CLI::ParseError& error) {
  // CLI11 asks for what is missing before it complains of what it doesn't know; a mistyped option
  // is often why something is missing.
  const std::vector<std::string> left = app.remaining();
  const auto is_option = [](const std::string& text) { return text.size() > 1 && text[0] == '-'; };
  const auto option = std::ranges::find_if(left, is_option);
  if (option != left.end()) return unknown_option(app, *option);
  if (!left.empty()) return "unexpected argument " + in_quotes(left.front());
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr) {
    const std::string text = error.what();
    return text.substr(0, text.find(':')) + " wants a value";
  }
  return printable(error.what());
}

}  // namespace

void refuse_empty_values(const CLI::App& app) {
  for (const CLI::Option* option : app.get_options()) {
    const std::vector<std::string>& values = option->results();
    if (std::ranges::find(values, std::string()) != values.end())
      throw CLI::ValidationError(option->get_name(), "wants a value, is empty");
  }
}

int report(const CLI::App& app, const CLI::ParseError& error) {
  if (error.get_exit_code() == 0) {
    app.exit(error);
    if (std::cout.flush()) return 0;
    std::fputs("error: standard output can't be written\n", stderr);
    return static_cast<int>(ErrorKind::io);
  }
  const std::string message = message_of(app, error);
  std::fprintf(stderr, "error: %s\nRun %s --help for the options.\n", message.c_str(),
               app.get_name().c_str());
  return static_cast<int>(ErrorKind::usage);
}

}  // namespace microtrace::cli
