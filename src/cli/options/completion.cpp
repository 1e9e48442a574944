#include "cli/options/completion.hpp"

#include "cli/options/help.hpp"
#include "cli/options/option.hpp"
#include "cli/options/shell_word.hpp"

#include <microtrace/error.hpp>

#include <string_view>
#include <vector>

namespace microtrace::cli {
namespace {

std::string joined(const std::vector<std::string>& words, std::string_view between) {
  std::string text;
  for (const std::string& word : words) text.append(text.empty() ? "" : between).append(word);
  return text;
}

/// Puts a backslash before each character that `special` contains.
std::string escaped(const std::string& text, std::string_view special) {
  std::string out;
  for (const char c : text) {
    if (special.find(c) != std::string_view::npos) out += '\\';
    out += c;
  }
  return out;
}

std::vector<Option> options_of(Command command, bool are_positional) {
  std::vector<Option> options;
  for (const OptionGroup& group : option_groups(command)) {
    for (const Option& option : group.options) {
      if (option.is_positional() == are_positional) options.push_back(option);
    }
  }
  return options;
}

std::vector<Option> named_options(Command command) {
  return options_of(command, false);
}

enum class Operands { scenes, files, folders };

/// Returns the kind of files that the command takes as positional arguments.
Operands operands_of(Command command) {
  const Option operand = options_of(command, true).front();
  if (operand.name() == "SCENE") return Operands::scenes;
  return operand.completion == Completion::folders ? Operands::folders : Operands::files;
}

/// Returns the names of all commands but `render`, separated by `between`.
std::string command_names(std::string_view between) {
  std::vector<std::string> names;
  for (const Command command : kCommands) {
    if (command != Command::render) names.emplace_back(name_of(command));
  }
  names.emplace_back("completion");
  return joined(names, between);
}

constexpr std::string_view kShells = "bash zsh fish";

std::vector<std::string> names_of(const Option& option) {
  const std::vector<std::string_view> names = option.all_names();
  return {names.begin(), names.end()};
}

std::vector<std::string> words_of(const Option& option) {
  return option.words == nullptr ? std::vector<std::string>() : option.words();
}

/// Returns true if the word after the option is its value.
bool has_value(const Option& option) {
  return !option.is_flag();
}

/// Returns bash's patterns for what precedes the value of an option: `prefix` and "--size", or
/// "--size=" if the value is a part of the same word. A switch has the latter too, so that no value
/// is offered.
std::vector<std::string> bash_patterns(const std::string& prefix, const Option& option) {
  std::vector<std::string> patterns;
  for (const std::string& name : names_of(option)) {
    if (has_value(option)) patterns.push_back(prefix + name);
    if (name.starts_with("--")) patterns.push_back(prefix + name + "=");
  }
  return patterns;
}

/// Returns the cases of bash's completion for the value of each option of a command, and for all
/// other words.
std::string bash_cases(Command command) {
  const std::string prefix = std::string(name_of(command)) + ",";
  std::vector<std::string> all_names, files, free;
  std::string cases;
  for (const Option& option : named_options(command)) {
    const std::vector<std::string> option_names = names_of(option);
    const std::vector<std::string> words = words_of(option);
    all_names.insert(all_names.end(), option_names.begin(), option_names.end());
    const std::vector<std::string> names = bash_patterns(prefix, option);
    if (names.empty()) continue;
    const bool takes_file = option.completion != Completion::none;
    if (!words.empty()) {
      cases += "    " + joined(names, "|") + ") words=" + in_single_quotes(joined(words, " "));
      if (option.takes_list) cases += " list=yes";
      cases += takes_file ? " files=yes ;;\n" : " ;;\n";
    } else {
      std::vector<std::string>& kind = takes_file ? files : free;
      kind.insert(kind.end(), names.begin(), names.end());
    }
  }
  if (!files.empty()) cases += "    " + joined(files, "|") + ") files=yes ;;\n";
  if (!free.empty()) cases += "    " + joined(free, "|") + ") return ;;\n";
  const Operands operands = operands_of(command);
  const std::string_view kind = operands == Operands::scenes    ? "scenes"
                                : operands == Operands::folders ? "folders"
                                                                : "yes";
  return cases + "    " + prefix + "*) names=" + in_single_quotes(joined(all_names, " ")) +
         " operands=" + std::string(kind) + " ;;\n";
}

std::string bash_script() {
  std::string cases;
  for (const Command command : kCommands) cases += bash_cases(command);
  return R"(# bash completion for microtrace
_microtrace() {
  local current=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} command=render
  local words= files= names= operands= whole= list= file
  if [[ $COMP_CWORD -gt 1 ]]; then
    case ${COMP_WORDS[1]} in )" +
         command_names("|") + R"() command=${COMP_WORDS[1]} ;; esac
  fi
  # The value may follow = in the same word, which bash divides at the characters of COMP_WORDBREAKS.
  if [[ $before == = ]]; then
    before=${COMP_WORDS[COMP_CWORD-2]}=
  elif [[ $current == = ]]; then
    before+== current=
  elif [[ $current == --*=* ]]; then
    before=${current%%=*}= current=${current#*=} whole=$before
  fi
  COMPREPLY=()
  case $command,$before in
)" + cases +
         "    completion,*) words='" + std::string(kShells) + R"(' ;;
  esac
  if [[ -n $names && $current == -* ]]; then
    words=$names
  elif [[ -n $names ]]; then
    files=$operands
    [[ $COMP_CWORD -gt 1 ]] || words=')" +
         command_names(" ") + R"('
  fi
  # Completes the last item of a list.
  [[ -n $list && $current == *,* ]] && whole+=${current%,*}, current=${current##*,}
  [[ -n $words ]] && mapfile -t COMPREPLY < <(compgen -W "$words" -P "$whole" -- "$current")
  [[ -n $files ]] || return
  compopt -o filenames 2>/dev/null
  while IFS= read -r file; do
    if [[ $files == yes || -d $file ]]; then
      COMPREPLY+=("$whole$file")
    elif [[ $files == scenes && ($file == *.json || $file == *.gltf || $file == *.glb) ]]; then
      COMPREPLY+=("$whole$file")
    fi
  done < <(compgen -f -- "$current")
}
complete -F _microtrace microtrace
)";
}

std::string zsh_value(const Option& option) {
  const std::vector<std::string> words = words_of(option);
  std::string value = ":" + escaped(std::string(option.metavar), ":\\") + ":";
  if (option.completion == Completion::folders) return value + "_files -/";
  if (option.completion == Completion::files) return value + "_files";
  if (words.empty()) return value + " ";
  if (option.takes_list) return value + "_values -s , item " + joined(words, " ");
  return value + "(" + joined(words, " ") + ")";
}

/// Returns the arguments of zsh's function _arguments for a command.
std::string zsh_arguments(Command command) {
  std::string script;
  for (const Option& option : named_options(command)) {
    const std::vector<std::string> names = names_of(option);
    for (const std::string& name : names) {
      std::string entry = option.is_repeatable ? "*" + name : "(" + joined(names, " ") + ")" + name;
      // =- requires a value to be in the same word, and a second colon makes it optional.
      if (!option.is_switch() && name.starts_with("--")) entry += has_value(option) ? "=" : "=-";
      entry += "[" + escaped(std::string(option.help), "[]:\\") + "]";
      if (!option.is_switch()) entry += (has_value(option) ? "" : ":") + zsh_value(option);
      script += "      " + in_single_quotes(entry) + " \\\n";
    }
  }
  constexpr std::string_view kScenes = R"#(_files -g "*.(json|gltf|glb)(-.)")#";
  std::string operands = "_files";
  if (operands_of(command) == Operands::folders) operands = "_files -/";
  if (operands_of(command) == Operands::scenes) operands = kScenes;
  if (command == Command::render) {
    script += "      '1: : _alternative \"commands:command:(" + command_names(" ") +
              ")\" \"scenes:scene:" + escaped(operands, "\"\\") + "\"' \\\n";
  }
  const std::string_view name = options_of(command, true).front().name();
  return script + "      '*:" + std::string(name) + ":" + operands + "'";
}

std::string zsh_script() {
  std::string script = R"(#compdef microtrace
local command=render
if (( CURRENT > 2 )); then
  case $words[2] in
    ()" + command_names("|") +
                       R"()
      command=$words[2]
      shift words
      (( CURRENT-- )) ;;
  esac
fi
case $command in
)";
  for (const Command command : kCommands) {
    script.append("  (").append(name_of(command)).append(")\n    _arguments -s \\\n");
    script += zsh_arguments(command) + " ;;\n";
  }
  return script + "  (completion)\n    _arguments '1:shell:(" + std::string(kShells) +
         ")' ;;\nesac\n";
}

std::string fish_script() {
  std::string script = R"(# fish completion for microtrace
function __microtrace_command
  set -l words (commandline -opc)
  if contains -- "$words[2]" )" +
                       command_names(" ") + R"(
    test $words[2] = $argv[1]
  else
    test render = $argv[1]
  end
end
# Completes the last item of a list.
function __microtrace_list
  set -l before (string match -r '^.*,' -- (string replace -r '^-[^=]*=' '' -- (commandline -ct)))
  for word in $argv
    echo "$before$word"
  end
end
complete -c microtrace -n 'test (count (commandline -opc)) -eq 1' -a ')" +
                       command_names(" ") + R"('
complete -c microtrace -n '__microtrace_command completion' -f -a ')" +
                       std::string(kShells) + "'\n";
  for (const Command command : kCommands) {
    for (const Option& option : named_options(command)) {
      script.append("complete -c microtrace -n '__microtrace_command ")
          .append(name_of(command))
          .append("'");
      for (const std::string& name : names_of(option)) {
        const bool is_long = name.starts_with("--");
        script += (is_long ? " -l " : " -s ") + name.substr(is_long ? 2 : 1);
      }
      if (!option.is_switch()) {
        const std::vector<std::string> words = words_of(option);
        const bool takes_file = option.completion != Completion::none;
        script += !has_value(option) ? " -f" : takes_file ? " -r -F" : " -x";
        if (!words.empty()) {
          const std::string all = joined(words, " ");
          script += " -a " +
                    in_single_quotes(option.takes_list ? "(__microtrace_list " + all + ")" : all);
        }
      }
      script += " -d " + in_single_quotes(escaped(std::string(option.help), "\\")) + "\n";
    }
  }
  return script;
}

constexpr const char* kHelp = R"(Usage: microtrace completion bash|zsh|fish

Prints a script by which a shell completes commands, options and their values.
)";

}  // namespace

bool is_completion(int argc, char** argv) {
  return argc > 1 && std::string_view(argv[1]) == "completion";
}

std::string completion_text(int argc, char** argv) {
  const std::string_view shell = argc == 3 ? argv[2] : "";
  if (shell == "bash") return bash_script();
  if (shell == "zsh") return zsh_script();
  if (shell == "fish") return fish_script();
  if (shell == "--help" || shell == "-h") return kHelp;
  throw Error(ErrorKind::usage, "", "microtrace completion expects bash, zsh or fish");
}

}  // namespace microtrace::cli
