#include "cli/arguments.hpp"
#include "cli/options/option.hpp"

#include <array>

namespace microtrace::cli {
namespace {

std::vector<std::string> tone_map_names() {
  std::vector<std::string> names;
  names.reserve(kToneMaps.size());
  for (const ToneMap map : kToneMaps) names.emplace_back(name_of(map));
  return names;
}

ToneMap parse_tone_map(const OptionValue& value) {
  if (const auto map = tone_map_named(value.text)) return *map;
  value.refuse(listed(tone_map_names()));
}

constexpr std::array kPpmEncodings{Choice<PpmEncoding>{"binary", PpmEncoding::binary},
                                   Choice<PpmEncoding>{"ascii", PpmEncoding::ascii}};

constexpr std::array kLightOptions{
    Option{
        .names = "--env",
        .metavar = "LIGHT",
        .help = "environment light: studio (built in), #rrggbb in sRGB, r,g,b in linear light, or "
                "the file of a latitude-longitude map (.hdr, .exr, ...); pictures "
                "without light don't depend on it",
        .default_value = "the scene's; the studio if the scene has neither lights nor an "
                         "environment",
        .samples = Samples::change,
        .completion = Completion::files,
        .words = [] { return std::vector<std::string>{"studio"}; },
        .set = [](Arguments& a,
                  const OptionValue& value) { a.environment.source = parse_environment(value); }},
    Option{.names = "--env-rotation",
           .metavar = "DEGREES",
           .help =
               "rotation of the environment about the vertical axis, counterclockwise seen from "
               "above",
           .default_value = "the scene's; 0 for --env",
           .samples = Samples::change,
           .set = [](Arguments& a,
                     const OptionValue& value) { a.environment.rotation = value.number(); }},
    Option{.names = "--env-intensity",
           .metavar = "X",
           .help = "factor that multiplies the environment's radiance",
           .default_value = "the scene's; 1 for --env",
           .samples = Samples::change,
           .set =
               [](Arguments& a, const OptionValue& value) {
                 a.environment.intensity = static_cast<float>(value.number(0, kMaxRadiance));
               }},
    Option{.names = "--ground",
           .metavar = "Y",
           .help = "horizontal ground that shows only shadows, at the height Y, or lowest: at the "
                   "lowest point of the scene",
           .implied_value = "lowest",
           .samples = Samples::change,
           .words = [] { return std::vector<std::string>{"lowest"}; },
           .set =
               [](Arguments& a, const OptionValue& value) {
                 a.path.ground = value.text == "lowest"
                                     ? Ground{}
                                     : Ground{.height = value.number(-3e38, 3e38)};
               }},
};
static_assert(is_complete(kLightOptions));

std::vector<std::string> automatic_word() {
  return {"auto"};
}

void set_exposure(Arguments& a, const OptionValue& value) {
  const bool is_automatic = value.text == "auto";
  a.display.automatic = is_automatic ? AutomaticExposure::always : AutomaticExposure::never;
  a.display.exposure = is_automatic ? std::nullopt : std::optional(value.number(-64, 64));
}

/// Returns the options for display with the defaults of a command.
constexpr std::array<Option, 4> display_table(std::string_view exposure, std::string_view tone_map,
                                              bool has_automatic_exposure) {
  return {
      Option{.names = "--denoise",
             .help = "remove the noise of a path-traced picture by the library Open Image Denoise, "
                     "which must be installed",
             .samples = Samples::keep,
             .set = [](Arguments& a, const OptionValue&) { a.denoises = true; }},
      Option{.names = "--exposure",
             .metavar = "EV",
             .help = "exposure of 8-bit pictures in stops, -64 to 64: radiance is multiplied by "
                     "2^EV",
             .default_value = exposure,
             .samples = Samples::keep,
             .words = has_automatic_exposure ? automatic_word : nullptr,
             .set = set_exposure},
      Option{.names = "--tonemap",
             .metavar = "NAME",
             .help = "tone mapping of 8-bit pictures: none, khronos-pbr-neutral, aces or agx",
             .default_value = tone_map,
             .samples = Samples::keep,
             .words = tone_map_names,
             .set = [](Arguments& a,
                       const OptionValue& value) { a.display.tone_map = parse_tone_map(value); }},
      Option{.names = "--ppm",
             .metavar = "KIND",
             .help = "encoding of PPM files: binary (P6) or ascii (P3)",
             .default_value = "binary",
             .samples = Samples::keep,
             .words = [] { return names_of(kPpmEncodings); },
             .set = [](Arguments& a,
                       const OptionValue& value) { a.ppm = value.choice(kPpmEncodings); }},
  };
}

constexpr std::string_view kToneMapOfRenderings =
    "khronos-pbr-neutral for path-traced renderings; else none";
constexpr auto kDisplayOfPictures = display_table(
    "auto, the exposure nearest to 0 at which surfaces are neither blown out nor black, for "
    "path-traced renderings of glTF assets with lights; else 0",
    kToneMapOfRenderings, true);
constexpr auto kDisplayOfDataSets = display_table("0", kToneMapOfRenderings, false);
constexpr auto kDisplayOfMerged =
    display_table("that of the first samples", "that of the first samples", false);
constexpr auto kDisplayOfCompared = display_table("0", "none", false);
static_assert(is_complete(kDisplayOfPictures));

}  // namespace

std::span<const Option> light_options() {
  return kLightOptions;
}

std::span<const Option> display_options(Command command) {
  switch (command) {
    case Command::dataset:
      return kDisplayOfDataSets;
    case Command::merge:
      return kDisplayOfMerged;
    case Command::compare:
      return kDisplayOfCompared;
    default:
      return kDisplayOfPictures;
  }
}

}  // namespace microtrace::cli
