#include "cli/arguments.hpp"
#include "cli/options/option.hpp"

#include <array>
#include <bit>
#include <string>

namespace microtrace::cli {
namespace {

std::filesystem::path parse_folder(const OptionValue& value) {
  std::error_code error;
  if (!std::filesystem::is_directory(value.text, error)) value.refuse("a folder that exists");
  return value.text;
}

ShutterTimes parse_shutter(const OptionValue& value) {
  const std::size_t colon = value.text.find(':');
  if (colon != std::string::npos) {
    const OptionValue open{.option = value.option, .text = value.text.substr(0, colon)};
    const OptionValue close{.option = value.option, .text = value.text.substr(colon + 1)};
    const ShutterTimes times{.open = open.number(), .close = close.number()};
    if (times.open <= times.close) return times;
  }
  value.refuse("OPEN:CLOSE, seconds in ascending order, such as 0:0.02");
}

std::uint32_t parse_times(const OptionValue& value) {
  const std::uint32_t count = value.whole_number(1, kMaxSamples);
  if (!std::has_single_bit(count)) value.refuse("a power of two");
  return count;
}

constexpr std::array kInstancings{Choice<Instancing>{"auto", Instancing::automatic},
                                  Choice<Instancing>{"share", Instancing::shared},
                                  Choice<Instancing>{"copy", Instancing::copied}};

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
    Option{.names = "--shutter",
           .metavar = "A:B",
           .help = "motion blur in path-traced pictures: the shutter opens A seconds and closes B "
                   "seconds after the time of the picture, which is --time (0 if not given) or "
                   "that of the frame",
           .default_value = "no motion blur",
           .samples = Samples::change,
           .set = [](Arguments& a, const OptionValue& value) { a.shutter = parse_shutter(value); }},
    Option{.names = "--shutter-times",
           .metavar = "N",
           .help = "number of times from A to B at which the scene is posed, a power of two from 1 "
                   "to 65536; each sample sees one of them",
           .default_value = "64",
           .samples = Samples::change,
           .needs = "--shutter",
           .set = [](Arguments& a,
                     const OptionValue& value) { a.shutter->count = parse_times(value); }},
    Option{.names = "--variant",
           .metavar = "NAME",
           .help = "material variant of a glTF asset, by name or by index from 0",
           .default_value = "the materials assigned in the file",
           .samples = Samples::change,
           .set = [](Arguments& a, const OptionValue& value) { a.load.variant = value.text; }},
    Option{.names = "--instances",
           .metavar = "HOW",
           .help = "how meshes are stored that a glTF asset contains several times: share (once), "
                   "copy (faster rays, more memory), or auto (share if copies would have more than "
                   "2^20 triangles); pictures don't depend on it",
           .default_value = "auto",
           .samples = Samples::keep,
           .words = [] { return names_of(kInstancings); },
           .set = [](Arguments& a,
                     const OptionValue& value) { a.load.instancing = value.choice(kInstancings); }},
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
