#include "cli/arguments.hpp"

#include "cli/arguments_sampling.hpp"
#include "cli/help.hpp"
#include "cli/option_values.hpp"
#include "cli/usage_error.hpp"
#include "cli/whole_numbers.hpp"

#include <microtrace/render.hpp>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

namespace microtrace::cli {
namespace {

constexpr const char* kFooter = R"(
Exit codes: 0 done, 1 failure inside, 2 usage, 3 invalid scene, 4 required feature unsupported,
            5 input or output, 6 a limit reached, 130 interrupted.

Examples:
  microtrace scenes/perspective1.json -o perspective1.ppm
  microtrace model.glb --size 1920x1080 --spp 16 -o model.png
  microtrace model.glb --aov id,depth,normal --background transparent -o model.exr
  microtrace scene.json -o - | other-program
  microtrace merge CHECKPOINT... -o picture.png)";

std::filesystem::path default_output(const std::string& scene, bool has_frames) {
  if (scene == "-") throw CLI::RequiredError("--output, where the scene is standard input,");
  return std::filesystem::path(scene).stem() += has_frames ? "_%04d.png" : ".png";
}

/// The words in which --help speaks of options' values, and the options' order.
void name_values(CLI::App& app) {
  constexpr std::array<std::pair<const char*, const char*>, 15> kNames{{
      {"SCENE", "FILE"},
      {"--output", "FILE"},
      {"--size", "WxH"},
      {"--crop", "RECT"},
      {"--integrator", "NAME"},
      {"--aov", "LIST"},
      {"--sidecar", "FILE"},
      {"--time", "S"},
      {"--animation", "NAME"},
      {"--variant", "NAME"},
      {"--frames", "RANGE"},
      {"--fps", "N"},
      {"--threads", "N"},
      {"--ppm", "KIND"},
      {"--progress", "KIND"},
  }};
  for (const auto& [option, value] : kNames) app.get_option(option)->type_name(value);
  for (const char* option : {"--threads", "--max-time", "--memory-limit", "--stats", "--progress",
                             "--strict", "--validate", "--quiet", "--verbose"}) {
    app.get_option(option)->group("Running");
  }
}

/// Values that are read when all options are known.
struct Texts {
  std::string output, size, crop, integrator, aovs, sidecar, time, frames, fps, statistics,
      memory_limit;
};

void add_options(CLI::App& app, Arguments& a, Texts& texts) {
  auto& [output, size, crop, integrator, aovs, sidecar, time, frames, fps, statistics,
         memory_limit] = texts;
  app.name("microtrace");
  app.description("microtrace: renders a JSON or glTF scene, exactly and the same everywhere");
  app.footer(kFooter);
  set_help_format(app);
  app.add_option("SCENE", a.scene, "scene file (.json, .gltf, .glb), or - for standard input")
      ->required();
  app.add_option("-o,--output", output,
                 "picture; its ending tells the kind (.ppm, .png, .exr, ...); - writes PPM to "
                 "standard output [SCENE's name with .png, in this folder]");
  app.add_option("--size", size, "WIDTHxHEIGHT in pixels [as the scene says, or 640x480]");
  app.add_option(
      "--crop", crop,
      "x0,y0,x1,y1: draw only the pixels from x0 to x1 - 1, y0 to y1 - 1, as they are in "
      "the whole picture; 0,0 is its upper left corner");
  add_light_options(app, a.surroundings, a.exposure);
  add_sampling_options(app, a.sampling);
  add_camera_options(app, a.viewpoint);
  app.add_option("--integrator", integrator,
                 "what the picture shows: flat (colours without light), path (with light, by path "
                 "tracing), or a quantity as --aov has them [glTF: path, JSON: flat]");
  app.add_option("--max-depth", a.path.max_depth,
                 "the most straight parts of a path of light, 2: direct light alone [32]")
      ->transform(whole_number_between(1, 65536))
      ->type_name("N");
  app.add_option_function<std::string>(
         "--backfaces",
         [&a](const std::string& text) {
           a.path.backfaces = text == "pass" ? Backfaces::pass : Backfaces::occlude;
         },
         "what light does at the back of what is one-sided, which the camera looks through: pass "
         "it too, or occlude: end there, as in rooms under a sun [pass]")
      ->check(CLI::IsMember({"pass", "occlude"}))
      ->type_name("KIND");
  app.add_option("--aov", aovs,
                 "exact quantities at pixel centres as further channels of an .exr file: depth, "
                 "distance, position, normal, face_normal, uv, barycentric, albedo, id; of path "
                 "also means over "
                 "samples: variance, samples, denoise_albedo, denoise_normal; with commas between");
  app.add_option("--sidecar", sidecar,
                 "JSON file for camera, objects with ids, names, boxes and visible pixels, and "
                 "materials [the picture's name with .json added, where --aov has id]");
  app.add_option("--time", time,
                 "seconds into the animation of a glTF asset [the pose that the file gives]");
  app.add_option("--variant", a.load.variant,
                 "variant of a glTF asset's materials, by name or by number from 0");
  app.add_option(
         "--allow-path", a.load.allowed_folders,
         "folder beside the scene's own to which a glTF asset's files may lead by .., and any "
         "scene's by symbolic links; may be given more than once")
      ->check(CLI::ExistingDirectory)
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->type_name("FOLDER");
  app.add_option("--animation", a.load.animation,
                 "animation that --time and --frames are of, by name or by number from 0; all: all "
                 "at once [the first]");
  app.add_option("--frames", frames,
                 "A:B: draw a picture of each frame from A to B; frame K is at K / fps seconds; "
                 "the picture's name has the number as in out_%04d.png")
      ->excludes("--time");
  app.add_option("--fps", fps, "frames in a second [24]")->needs("--frames");
  app.add_option("-t,-j,--threads", a.threads, "threads [one for each processor]")
      ->transform(whole_number_between(1, 1024));
  app.add_option_function<std::string>(
         "--max-time",
         [&a](const std::string& text) {
           a.max_time = parse_number("--max-time", text);
           if (!(*a.max_time > 0))
             throw CLI::ValidationError("--max-time", "must be above 0, is " + text);
         },
         "seconds after which the run ends with exit code 6 and no picture, whatever it does then; "
         "for scenes that are not trusted [none]")
      ->type_name("S");
  app.add_option(
         "--memory-limit", memory_limit,
         "the most memory to take, in bytes or with K, M or G as in 4G: what needs more ends "
         "with exit 6 before it is taken [three quarters of what is free]")
      ->type_name("BYTES");
  app.add_option("--ppm", a.ppm, "encoding of PPM files: binary (P6) or ascii (P3) [binary]")
      ->transform(CLI::Transformer(std::map<std::string, PpmEncoding>{
          {"binary", PpmEncoding::binary}, {"ascii", PpmEncoding::ascii}}));
  app.add_flag("--stats{text}", statistics,
               "time and memory used, to standard error; --stats=json for programs")
      ->check(CLI::IsMember({"text", "json"}));
  app.add_option("--progress", a.progress,
                 "bar: drawn where standard error is a terminal; json: lines for programs, to "
                 "standard error; none [bar]")
      ->transform(CLI::Transformer(std::map<std::string, Progress>{
          {"none", Progress::none}, {"bar", Progress::bar}, {"json", Progress::json}}));
  app.add_flag("--strict", a.strict, "warnings are errors: exit 3, no picture");
  app.add_flag("--validate", a.validate, "check the scene, print the verdict, draw nothing");
  app.add_flag("-q,--quiet", a.quiet,
               "no warnings, no progress bar, no line about what was written");
  app.add_flag("-v,--verbose", a.verbose, "what was read, how it is drawn and what was written")
      ->excludes("--quiet");
  app.set_version_flag("--version", "microtrace " MICROTRACE_VERSION);
  name_values(app);
}

}  // namespace

std::vector<OptionHelp> list_options() {
  CLI::App app;
  Arguments arguments;
  Texts texts;
  add_options(app, arguments, texts);
  std::vector<OptionHelp> options;
  for (const CLI::Option* option : app.get_options()) {
    if (!option->nonpositional()) continue;
    OptionHelp& help = options.emplace_back();
    for (const std::string& name : option->get_snames()) help.names.push_back("-" + name);
    for (const std::string& name : option->get_lnames()) help.names.push_back("--" + name);
    help.has_value = option->get_items_expected_min() > 0 && option->get_type_size() > 0;
    if (help.has_value) help.value = value_name(*option);
    help.text = option->get_description();
  }
  return options;
}

Parsed parse_arguments(int argc, char** argv) {
  Parsed parsed;
  Arguments& a = parsed.arguments;
  CLI::App app;
  Texts texts;
  add_options(app, a, texts);
  const auto& [output, size, crop, integrator, aovs, sidecar, time, frames, fps, statistics,
               memory_limit] = texts;
  try {
    app.parse(argc, argv);
    refuse_empty_values(app);
    if (app.count("--size") > 0) a.size = parse_size(size);
    if (app.count("--integrator") > 0) a.wanted = parse_integrator(integrator);
    finish_sampling(app, a.sampling);
    if (app.count("--aov") > 0) a.aovs = parse_aovs(aovs);
    finish_camera(app, a.viewpoint);
    if (app.count("--crop") > 0) a.crop = parse_crop(crop);
    if (app.count("--memory-limit") > 0)
      a.memory_limit = parse_bytes("--memory-limit", memory_limit);
    if (app.count("--time") > 0) a.load.time = parse_number("--time", time);
    if (app.count("--frames") > 0) a.frames = parse_frames(frames);
    if (app.count("--fps") > 0) a.frames->fps = parse_fps(fps);
    if (app.count("--animation") > 0 && !a.load.time && !a.frames)
      throw CLI::RequiredError("--time or --frames, where --animation is given,");
    if (!statistics.empty())
      a.statistics = statistics == "json" ? Statistics::json : Statistics::text;
    a.output = output;
    if (output.empty() && !a.validate && !a.sampling.shard)
      a.output = default_output(a.scene, a.frames.has_value());
    a.sidecar = sidecar;
    if (sidecar.empty() && std::ranges::find(a.aovs.exact, Aov::id) != a.aovs.exact.end())
      (a.sidecar = a.output) += ".json";
    if (a.frames && !a.output.empty()) check_pattern("--output", a.output.string());
    if (a.frames && !a.sidecar.empty()) check_pattern("--sidecar", a.sidecar.string());
  } catch (const CLI::ParseError& error) {
    parsed.exit_code = report(app, error);
  }
  return parsed;
}

void settle(Arguments& a, SceneFormat format) {
  const bool is_gltf = format == SceneFormat::gltf;
  a.integrator = a.wanted.value_or(is_gltf ? Technique::path : Technique::flat);
  const bool has_light = a.integrator == Subject(Technique::path);
  if (a.surroundings.shows_environment() && !has_light) {
    throw Error(ErrorKind::usage, "",
                "--background: env is seen only with light; use --integrator path");
  }
  if (!a.aovs.sampled.empty() && !has_light) {
    throw Error(ErrorKind::usage, "",
                "--aov: " + std::string(name_of(a.aovs.sampled.front())) +
                    " is of pictures with light; use --integrator path");
  }
  if (a.sampling.samples == 0) a.sampling.samples = has_light ? 64 : 1;
  check_sampling(a.sampling, has_light);
  // Lighter than shadows and darker than highlights, so that models stand out.
  if (is_gltf && has_light && !a.surroundings.background)
    a.surroundings.background = Background{.color = Vec3(0.6F)};
}

std::unique_ptr<Integrator> make_integrator(const Arguments& arguments) {
  if (const auto* aov = std::get_if<Aov>(&arguments.integrator))
    return std::make_unique<AovIntegrator>(*aov);
  if (std::get<Technique>(arguments.integrator) == Technique::path)
    return std::make_unique<PathIntegrator>(arguments.path);
  return std::make_unique<FlatIntegrator>();
}

}  // namespace microtrace::cli
