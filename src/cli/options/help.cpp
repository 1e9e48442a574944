#include "cli/options/help.hpp"

#include <cstddef>
#include <sstream>
#include <string_view>

namespace microtrace::cli {
namespace {

// Widths in characters of the columns for names and descriptions.
constexpr std::size_t kLeft = 27, kRight = 72;

constexpr std::string_view kRenderUsage =
    R"(microtrace: renders JSON and glTF scenes with exact visibility and the same bytes everywhere
Usage: microtrace [OPTIONS] SCENE
       microtrace merge [OPTIONS] CHECKPOINT...
       microtrace dataset [OPTIONS] SCENE -o FOLDER
       microtrace verify [OPTIONS] FOLDER
       microtrace explain [OPTIONS] SCENE --pixel x,y
       microtrace compare [OPTIONS] PICTURE PICTURE
       microtrace view [OPTIONS] SCENE
       microtrace completion bash|zsh|fish
)";

constexpr std::string_view kMergeUsage =
    R"(microtrace merge: joins the samples in several checkpoints to one picture or checkpoint
Usage: microtrace merge [OPTIONS] CHECKPOINT...
)";

constexpr std::string_view kDatasetUsage =
    R"(microtrace dataset: renders many views of a scene into a folder
Usage: microtrace dataset [OPTIONS] SCENE -o FOLDER
)";

constexpr std::string_view kVerifyUsage =
    R"(microtrace verify: checks the files of a data set, and renders some of its views again
Usage: microtrace verify [OPTIONS] FOLDER
)";

constexpr std::string_view kExplainUsage =
    R"(microtrace explain: lists what a ray meets, with the numbers that decide, and what is visible
Usage: microtrace explain [OPTIONS] SCENE --pixel x,y
       microtrace explain [OPTIONS] SCENE --ray ox,oy,oz,dx,dy,dz
)";

constexpr std::string_view kCompareUsage =
    R"(microtrace compare: compares two pictures; the exit code is 7 if they differ
Usage: microtrace compare [OPTIONS] PICTURE PICTURE
)";

constexpr std::string_view kViewUsage =
    R"(microtrace view: shows a scene on a page in the browser
Usage: microtrace view [OPTIONS] SCENE
)";

std::string_view usage_of(Command command) {
  switch (command) {
    case Command::render:
      return kRenderUsage;
    case Command::merge:
      return kMergeUsage;
    case Command::dataset:
      return kDatasetUsage;
    case Command::verify:
      return kVerifyUsage;
    case Command::explain:
      return kExplainUsage;
    case Command::compare:
      return kCompareUsage;
    case Command::view:
      return kViewUsage;
  }
  return {};
}

constexpr std::string_view kFooter = R"(
Exit codes: 0 done, 1 internal error, 2 usage error, 3 invalid scene, 4 required feature
            unsupported, 5 input or output error, 6 limit reached, 7 pictures differ,
            130 interrupted, 143 terminated.

Examples:
  microtrace scenes/perspective1.json -o perspective1.ppm
  microtrace model.glb --size 1920x1080 --spp 16 -o model.png
  microtrace model.glb --aov id,depth,normal --background transparent -o model.exr
  microtrace scene.json -o - | other-program
  microtrace merge CHECKPOINT... -o picture.png
  microtrace explain scenes/perspective1.json --pixel 320,240
)";

/// Breaks the text into lines that fit the right column. Indents all lines but the first.
std::string wrapped(const std::string& text) {
  std::istringstream words(text);
  std::string result;
  std::size_t length = 0;
  for (std::string word; words >> word;) {
    const bool breaks = length > 0 && length + 1 + word.size() > kRight;
    if (breaks) {
      result += '\n' + std::string(kLeft, ' ');
      length = 0;
    } else if (length > 0) {
      result += ' ';
      ++length;
    }
    result += word;
    length += word.size();
  }
  return result;
}

std::string line_of(const Option& option) {
  std::string line = "  ";
  for (const std::string_view name : option.all_names()) {
    if (line.size() > 2) line += ", ";
    line += name;
  }
  if (!option.implied_value.empty()) {
    line.append("[=").append(option.metavar).append("]");
  } else if (!option.is_switch() && option.metavar != option.names) {
    line.append(" ").append(option.metavar);
  }
  if (option.is_positional() && option.is_repeatable) line += "...";
  line += line.size() + 2 > kLeft ? '\n' + std::string(kLeft, ' ')
                                  : std::string(kLeft - line.size(), ' ');
  std::string text(option.help);
  if (!option.needs.empty()) text.append("; needs ").append(option.needs);
  if (!option.default_value.empty()) text.append(" [").append(option.default_value).append("]");
  return line + wrapped(text) + '\n';
}

}  // namespace

std::string_view name_of(Command command) {
  switch (command) {
    case Command::render:
      return "render";
    case Command::merge:
      return "merge";
    case Command::dataset:
      return "dataset";
    case Command::verify:
      return "verify";
    case Command::explain:
      return "explain";
    case Command::compare:
      return "compare";
    case Command::view:
      return "view";
  }
  return {};
}

std::string program_name(Command command) {
  std::string name = "microtrace";
  if (command != Command::render) name.append(" ").append(name_of(command));
  return name;
}

std::string help_text(Command command) {
  std::string text(usage_of(command));
  text += "Defaults are in [brackets].\n";
  std::string_view title;
  for (const OptionGroup& group : option_groups(command)) {
    if (group.title != title) text.append("\n").append(group.title).append(":\n");
    title = group.title;
    for (const Option& option : group.options) text += line_of(option);
  }
  if (command == Command::render) text += kFooter;
  return text;
}

}  // namespace microtrace::cli
