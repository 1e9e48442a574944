#include "cli/arguments.hpp"
#include "cli/options/option.hpp"

#include <array>

namespace microtrace::cli {
namespace {

std::filesystem::path parse_folder(const OptionValue& value) {
  std::error_code error;
  if (!std::filesystem::is_directory(value.text, error)) value.refuse("a folder that exists");
  return value.text;
}

constexpr std::array kAssetOptions{
    Option{.names = "--time",
           .metavar = "S",
           .help = "time in seconds at which the animation of a glTF asset is evaluated",
           .default_value = "the pose without animation",
           .samples = Samples::change,
           .set = [](Arguments& a, const OptionValue& value) { a.load.time = value.number(); }},
    Option{
        .names = "--animation",
        .metavar = "NAME",
        .help = "animation for --time and --frames, by name or by index from 0, or all (at once)",
        .default_value = "the first",
        .samples = Samples::change,
        .set = [](Arguments& a, const OptionValue& value) { a.load.animation = value.text; }},
    Option{.names = "--frames",
           .metavar = "A:B",
           .help =
               "render one picture for each frame from A to B, both included; frame K shows the "
               "pose at K / fps seconds; the output name contains a placeholder for the frame "
               "number, as in out_%04d.png",
           .default_value = "one picture",
           .samples = Samples::change,
           .excludes = "--time",
           .set = [](Arguments& a, const OptionValue& value) { a.frames = parse_frames(value); }},
    Option{.names = "--fps",
           .metavar = "N",
           .help = "frames per second",
           .default_value = "24",
           .samples = Samples::change,
           .needs = "--frames",
           .set = [](Arguments& a,
                     const OptionValue& value) { a.frames->fps = value.positive_number(); }},
    Option{.names = "--variant",
           .metavar = "NAME",
           .help = "material variant of a glTF asset, by name or by index from 0",
           .default_value = "the materials assigned in the file",
           .samples = Samples::change,
           .set = [](Arguments& a, const OptionValue& value) { a.load.variant = value.text; }},
    Option{.names = "--allow-path",
           .metavar = "FOLDER",
           .help = "additional folder from which a glTF asset may load files, and into which the "
                   "symbolic links in any scene's folder may lead; may be repeated",
           .default_value = "none",
           .samples = Samples::keep,
           .completion = Completion::folders,
           .is_repeatable = true,
           .set =
               [](Arguments& a, const OptionValue& value) {
                 a.load.allowed_folders.push_back(parse_folder(value));
               }},
};
static_assert(is_complete(kAssetOptions));

}  // namespace

std::span<const Option> asset_options() {
  return kAssetOptions;
}

}  // namespace microtrace::cli
