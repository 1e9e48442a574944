#include "cli/options/parse.hpp"

#include "cli/options/check_words.hpp"
#include "cli/options/help.hpp"
#include "cli/options/usage_error.hpp"

#include <microtrace/error.hpp>
#include <microtrace/version.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

namespace microtrace::cli {
namespace {

/// An option that is given on the command line.
struct Given {
  const Option* option;
  std::vector<std::string> values;
};

/// Splits the command line with CLI11. The option table's rows convert the values.
class Parser {
 public:
  explicit Parser(Command command) : command_(command) {
    app_.name(program_name(command));
    app_.set_help_flag();
    for (const OptionGroup& group : option_groups(command)) {
      for (const Option& option : group.options) add(option);
    }
    for (const auto& [option, added] : options_) {
      if (!option->needs.empty()) added->needs(app_.get_option(std::string(option->needs)));
      std::istringstream excluded{std::string(option->excludes)};
      // `excludes` may name options of other tables that this command lacks.
      for (std::string name; excluded >> name;) {
        if (CLI::Option* other = app_.get_option_no_throw(name)) added->excludes(other);
      }
    }
  }

  /// Returns the given options with their values. Throws CLI::ParseError and Error (usage).
  std::vector<Given> parse(int argc, char** argv) {
    check_words(command_, {argv + 1, argv + argc});
    app_.parse(argc, argv);
    std::vector<Given> given;
    for (const auto& [option, added] : options_) {
      if (added->count() == 0 || option->set == nullptr) continue;
      if (option->is_switch()) {
        given.push_back({option, {""}});
        continue;
      }
      const std::vector<std::string> values = added->reduced_results();
      if (std::ranges::find(values, std::string()) != values.end())
        refuse_empty(std::string(option->name()));
      given.push_back({option, values});
    }
    return given;
  }

  [[nodiscard]] const CLI::App& app() const { return app_; }

 private:
  void add(const Option& option) {
    std::string names(option.names);
    CLI::Option* added = nullptr;
    if (option.name() == "--help") {
      added = app_.set_help_flag(names);
    } else if (option.name() == "--version") {
      added = app_.set_version_flag(names, "microtrace " MICROTRACE_VERSION_TEXT);
    } else if (option.is_flag()) {
      if (!option.implied_value.empty()) names.append("{").append(option.implied_value).append("}");
      added = app_.add_flag(names);
    } else {
      added = app_.add_option(names);
    }
    if (option.is_required) added->required();
    if (option.is_repeatable) {
      // A positional argument takes all remaining words. An option takes one word per occurrence.
      added->expected(option.is_positional() ? -1 : 1);
      added->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    }
    options_.emplace_back(&option, added);
  }

  Command command_;
  CLI::App app_;
  std::vector<std::pair<const Option*, CLI::Option*>> options_{};
};

/// Returns true if the option has the value that it has without being given. Descriptions of
/// defaults are no values.
bool is_default(const Given& given) {
  const std::string_view usual = given.option->default_value;
  return !usual.empty() && given.values.size() == 1 && given.values.front() == usual;
}

std::string identity_of(const std::vector<Given>& all) {
  std::string identity;
  for (const Given& given : all) {
    const auto& [option, values] = given;
    if (option->samples != Samples::change || is_default(given)) continue;
    identity += option->name();
    char before = '\t';
    for (const std::string& value : values) {
      identity += before;
      // Values may contain any bytes, so the two characters that separate entries are replaced with
      // spaces.
      for (const char c : value) identity += c == '\n' || c == '\t' ? ' ' : c;
      before = ' ';
    }
    identity += '\n';
  }
  return identity;
}

bool is_of(const Option& option, std::span<const Option> table) {
  return std::ranges::find(table, option.names, &Option::names) != table.end();
}

/// Returns true if the option only changes where and how the program runs.
bool is_of_run(const Option& option) {
  return is_of(option, running_options()) || is_of(option, common_options());
}

/// Sets the identity of a data set: all options but those that change only where and how the
/// program runs and reads the scene, and those that have their defaults. The command line also has
/// --allow-path, without which the scene can't be read again.
void identify_dataset(const std::vector<Given>& all, DatasetOptions& dataset) {
  for (const Given& given : all) {
    const auto& [option, values] = given;
    constexpr std::array kNotOfFiles = {"--output", "--shard", "--instances"};
    if (std::ranges::find(kNotOfFiles, option->name()) != kNotOfFiles.end()) continue;
    if (is_of_run(*option) || is_default(given)) continue;
    for (const std::string& value : values) {
      std::string argument(option->name());
      if (option->is_positional()) {
        argument = value.starts_with('-') ? "./" + value : value;  // the scene
      } else {
        if (!option->is_switch()) argument.append("=").append(value);
        if (option->name() != "--allow-path")
          dataset.identity.append(dataset.identity.empty() ? "" : " ").append(argument);
      }
      dataset.command_line.push_back(std::move(argument));
    }
  }
}

/// Returns the given options that change the picture, as words of a command line.
std::vector<std::string> picture_words(const std::vector<Given>& given) {
  std::vector<std::string> words;
  for (const auto& [option, values] : given) {
    if (is_of_run(*option) || is_of(*option, view_options())) continue;
    for (const std::string& value : values) {
      words.emplace_back(option->name());
      // A value that may be omitted can't be a word of its own.
      if (!option->implied_value.empty())
        words.back().append("=").append(value);
      else if (!option->is_switch())
        words.push_back(value);
    }
  }
  return words;
}

std::filesystem::path default_output(const std::string& scene, bool has_frames) {
  if (scene == "-") refuse_usage("--output is required if the scene is standard input");
  std::string stem = std::filesystem::path(scene).stem().string();
  if (!has_frames) return stem + ".png";
  for (std::size_t at = stem.find('%'); at != stem.npos; at = stem.find('%', at + 2))
    stem.insert(at, 1, '%');
  return stem + "_%04d.png";
}

/// Checks that names of files contain the frame number if frames are rendered or merged.
void check_patterns(const Arguments& a) {
  if (!a.frames) return;
  const auto check = [](const char* option, const std::filesystem::path& name) {
    if (!name.empty()) check_pattern(option, name.string());
  };
  check("--output", a.output);
  check("--sidecar", a.sidecar);
  check("--checkpoint", a.sampling.checkpoint);
  for (const std::filesystem::path& name : a.sampling.resume) check("--resume", name);
  for (const std::filesystem::path& name : a.checkpoints) check("CHECKPOINT", name);
}

void check_target(const CameraOptions& camera) {
  const bool has_position = camera.eye || (camera.orbit && camera.orbit->distance);
  if (camera.target && !has_position)
    refuse_usage("--target requires --eye, or --view with a distance");
}

/// Checks rules about options of cameras and animations.
void check_view(const Arguments& a) {
  check_target(a.camera);
  if (a.camera.vertical_fov && a.camera.is_of_scene())
    refuse_usage("--fov requires --view or --eye");
  if (!a.load.animation.empty() && !a.load.time && !a.frames)
    refuse_usage("--animation requires --time or --frames");
}

/// Checks rules that involve several options and sets values that depend on others.
void complete(Arguments& a) {
  if (a.shutter && !a.frames && !a.load.time) a.load.time = 0;
  check_view(a);
  if (a.output.empty() && !a.validate && !a.sampling.shard)
    a.output = default_output(a.scene, a.frames.has_value());
  if (a.sidecar.empty() && !a.sampling.shard &&
      std::ranges::find(a.aovs.exact, Aov::id) != a.aovs.exact.end())
    (a.sidecar = a.output) += ".json";
  check_patterns(a);
}

/// Throws CLI::ParseError and Error (usage).
Arguments parse_with(Parser& parser, Command command, int argc, char** argv) {
  Arguments a;
  const std::vector<Given> given = parser.parse(argc, argv);
  for (const auto& [option, values] : given) {
    for (const std::string& value : values) option->set(a, {std::string(option->name()), value});
  }
  if (command == Command::render) complete(a);
  if (command == Command::merge) check_patterns(a);
  if (command == Command::view) {
    check_view(a);
    a.view.words = picture_words(given);
  }
  if (command == Command::explain) {
    check_view(a);
    if (!a.explain.pixel && !a.explain.ray) refuse_usage("explain needs --pixel or --ray");
  }
  if (command == Command::dataset) {
    check_target(a.camera);
    identify_dataset(given, a.dataset);
  }
  a.identity = identity_of(given);
  return a;
}

}  // namespace

Parsed parse_arguments(Command command, int argc, char** argv) {
  Parsed parsed;
  Parser parser(command);
  try {
    parsed.arguments = parse_with(parser, command, argc, argv);
  } catch (const CLI::CallForHelp&) {
    parsed.output = help_text(command);
  } catch (const CLI::CallForVersion& version) {
    parsed.output = std::string(version.what()) + "\n";
  } catch (const CLI::ParseError& error) {
    parsed.exit_code = report_usage_error(command, message_of(command, parser.app(), error));
  } catch (const Error& error) {
    parsed.exit_code = report_usage_error(command, error.what());
  }
  return parsed;
}

Arguments parse_words(Command command, std::vector<std::string> words) {
  words.insert(words.begin(), program_name(command));
  std::vector<char*> pointers;
  pointers.reserve(words.size());
  for (std::string& word : words) pointers.push_back(word.data());
  Parser parser(command);
  try {
    return parse_with(parser, command, static_cast<int>(pointers.size()), pointers.data());
  } catch (const CLI::CallForHelp&) {
    refuse_usage("--help: not available here");
  } catch (const CLI::ParseError& error) {
    refuse_usage(message_of(command, parser.app(), error));
  }
}

}  // namespace microtrace::cli
