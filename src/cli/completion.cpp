#include "cli/completion.hpp"

#include "cli/arguments.hpp"
#include "cli/option_values.hpp"

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

/// With a backslash before each of these characters.
std::string escaped(const std::string& text, std::string_view special) {
  std::string out;
  for (const char c : text) {
    if (special.find(c) != std::string_view::npos) out += '\\';
    out += c;
  }
  return out;
}

/// In single quotes, within which no shell but fish reads backslashes.
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

bool takes_file(const OptionHelp& option) {
  return option.value == "FILE" || option.value == "FOLDER" || option.names.back() == "--env";
}

std::string bash_script(const std::vector<OptionHelp>& options) {
  std::vector<std::string> names, files, free;
  std::string choices;
  for (const OptionHelp& option : options) {
    names.insert(names.end(), option.names.begin(), option.names.end());
    if (!option.has_value) continue;
    const std::vector<std::string> words = words_of(option.names.back());
    if (!words.empty()) {
      choices +=
          "    " + joined(option.names, "|") + ") words=" + in_single_quotes(joined(words, " "));
      choices += takes_file(option) ? " files=yes ;;\n" : " ;;\n";
    } else {
      std::vector<std::string>& kind = takes_file(option) ? files : free;
      kind.insert(kind.end(), option.names.begin(), option.names.end());
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
         in_single_quotes(joined(names, " ")) + R"(
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

std::string zsh_script(const std::vector<OptionHelp>& options) {
  std::string script = "#compdef microtrace\n_arguments -s \\\n";
  for (const OptionHelp& option : options) {
    for (const std::string& name : option.names) {
      std::string entry = "(" + joined(option.names, " ") + ")" + name;
      if (option.has_value && name.starts_with("--")) entry += '=';
      entry += "[" + escaped(option.text, "[]:\\") + "]";
      if (option.has_value) {
        const std::vector<std::string> words = words_of(option.names.back());
        entry += ":" + option.value + ":";
        entry += takes_file(option) ? "_files"
                 : words.empty()    ? " "
                                    : "(" + joined(words, " ") + ")";
      }
      script += "  " + in_single_quotes(entry) + " \\\n";
    }
  }
  return script + "  '*:scene:_files -g \"*.(json|gltf|glb)(-.)\"'\n";
}

std::string fish_script(const std::vector<OptionHelp>& options) {
  std::string script = "# fish completion for microtrace\n";
  for (const OptionHelp& option : options) {
    script += "complete -c microtrace";
    for (const std::string& name : option.names) {
      const bool is_long = name.starts_with("--");
      script += (is_long ? " -l " : " -s ") + name.substr(is_long ? 2 : 1);
    }
    if (option.has_value) {
      const std::vector<std::string> words = words_of(option.names.back());
      script += takes_file(option) ? " -r -F" : " -x";
      if (!words.empty()) script += " -a " + in_single_quotes(joined(words, " "));
    }
    script += " -d " + in_single_quotes(escaped(option.text, "\\")) + "\n";
  }
  return script;
}

}  // namespace

bool is_completion(int argc, char** argv) {
  return argc > 1 && std::string_view(argv[1]) == "completion";
}

std::optional<std::string> completion_script(std::string_view shell) {
  const std::vector<OptionHelp> options = list_options();
  if (shell == "bash") return bash_script(options);
  if (shell == "zsh") return zsh_script(options);
  if (shell == "fish") return fish_script(options);
  return std::nullopt;
}

int print_completion(int argc, char** argv) {
  const std::optional<std::string> script = argc == 3 ? completion_script(argv[2]) : std::nullopt;
  if (!script) {
    std::fputs("error: microtrace completion wants one of bash, zsh, fish\n", stderr);
    return static_cast<int>(ErrorKind::usage);
  }
  if (std::fputs(script->c_str(), stdout) == EOF || std::fflush(stdout) != 0) {
    std::fputs("error: standard output can't be written\n", stderr);
    return static_cast<int>(ErrorKind::io);
  }
  return 0;
}

}  // namespace microtrace::cli
