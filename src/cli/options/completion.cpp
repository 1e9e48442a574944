#include "cli/options/completion.hpp"

#include "cli/options/option.hpp"

#include <microtrace/error.hpp>

#include <cstdio>
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

/// Quotes the text for any shell. Fish is the only one that interprets backslashes within single
/// quotes.
std::string in_single_quotes(const std::string& text) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'') {
      out += R"('\'')";
    } else {
      out += c;
    }
  }
  return out + "'";
}

std::vector<Option> named_options() {
  std::vector<Option> options;
  for (const OptionGroup& group : option_groups(Command::render)) {
    for (const Option& option : group.options) {
      if (!option.is_positional()) options.push_back(option);
    }
  }
  return options;
}

std::vector<std::string> names_of(const Option& option) {
  const std::vector<std::string_view> names = option.all_names();
  return {names.begin(), names.end()};
}

std::vector<std::string> words_of(const Option& option) {
  return option.words != nullptr ? option.words() : std::vector<std::string>{};
}

/// Returns true if the word after the option is its value.
bool has_value(const Option& option) {
  return !option.is_flag();
}

std::string bash_script() {
  std::vector<std::string> all_names, files, free;
  std::string choices;
  for (const Option& option : named_options()) {
    const std::vector<std::string> names = names_of(option), words = words_of(option);
    all_names.insert(all_names.end(), names.begin(), names.end());
    if (!has_value(option)) continue;
    const bool takes_file = option.completion != Completion::none;
    if (!words.empty()) {
      choices += "    " + joined(names, "|") + ") words=" + in_single_quotes(joined(words, " "));
      choices += takes_file ? " files=yes ;;\n" : " ;;\n";
    } else {
      std::vector<std::string>& kind = takes_file ? files : free;
      kind.insert(kind.end(), names.begin(), names.end());
    }
  }
  return R"(# bash completion for microtrace
_microtrace() {
  local current=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} words= files= file
  COMPREPLY=()
  case $before in
)" + choices +
         "    " + joined(files, "|") + ") files=yes ;;\n    " + joined(free, "|") + R"() return ;;
    *)
      if [[ $current == -* ]]; then
        words=)" +
         in_single_quotes(joined(all_names, " ")) + R"(
      else
        files=scenes
      fi
      ;;
  esac
  [[ -n $words ]] && mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
  [[ -n $files ]] || return
  compopt -o filenames 2>/dev/null
  while IFS= read -r file; do
    if [[ $files == yes || -d $file || $file == *.json || $file == *.gltf || $file == *.glb ]]; then
      COMPREPLY+=("$file")
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
  return value + (words.empty() ? " " : "(" + joined(words, " ") + ")");
}

std::string zsh_script() {
  std::string script = "#compdef microtrace\n_arguments -s \\\n";
  for (const Option& option : named_options()) {
    const std::vector<std::string> names = names_of(option);
    for (const std::string& name : names) {
      std::string entry = option.is_repeatable ? "*" + name : "(" + joined(names, " ") + ")" + name;
      if (has_value(option) && name.starts_with("--")) entry += '=';
      entry += "[" + escaped(std::string(option.help), "[]:\\") + "]";
      if (has_value(option)) entry += zsh_value(option);
      script += "  " + in_single_quotes(entry) + " \\\n";
    }
  }
  return script + "  '*:scene:_files -g \"*.(json|gltf|glb)(-.)\"'\n";
}

std::string fish_script() {
  std::string script = "# fish completion for microtrace\n";
  for (const Option& option : named_options()) {
    script += "complete -c microtrace";
    for (const std::string& name : names_of(option)) {
      const bool is_long = name.starts_with("--");
      script += (is_long ? " -l " : " -s ") + name.substr(is_long ? 2 : 1);
    }
    if (has_value(option)) {
      const std::vector<std::string> words = words_of(option);
      script += option.completion != Completion::none ? " -r -F" : " -x";
      if (!words.empty()) script += " -a " + in_single_quotes(joined(words, " "));
    }
    script += " -d " + in_single_quotes(escaped(std::string(option.help), "\\")) + "\n";
  }
  return script;
}

}  // namespace

bool is_completion(int argc, char** argv) {
  return argc > 1 && std::string_view(argv[1]) == "completion";
}

std::optional<std::string> completion_script(std::string_view shell) {
  if (shell == "bash") return bash_script();
  if (shell == "zsh") return zsh_script();
  if (shell == "fish") return fish_script();
  return std::nullopt;
}

int print_completion(int argc, char** argv) {
  const std::optional<std::string> script = argc == 3 ? completion_script(argv[2]) : std::nullopt;
  if (!script) {
    std::fputs("error: microtrace completion expects bash, zsh or fish\n", stderr);
    return static_cast<int>(ErrorKind::usage);
  }
  if (std::fputs(script->c_str(), stdout) == EOF || std::fflush(stdout) != 0) {
    std::fputs("error: standard output can't be written\n", stderr);
    return static_cast<int>(ErrorKind::io);
  }
  return 0;
}

}  // namespace microtrace::cli
