#include "cli/arguments.hpp"

#include "scene/validate.hpp"

#include <microtrace/render.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <string_view>

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
  microtrace scene.json -o - | other-program)";

std::optional<std::uint32_t> whole_number(std::string_view text) {
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

ImageSize parse_size(const std::string& text) {
  const std::size_t x = text.find('x');
  const auto width = whole_number(std::string_view(text).substr(0, x));
  const auto height =
      x == std::string::npos ? std::nullopt : whole_number(std::string_view(text).substr(x + 1));
  if (!width || !height)
    throw CLI::ValidationError("--size", "wants WIDTHxHEIGHT in pixels, as 640x480, not " + text);
  const ImageSize size{.width = *width, .height = *height};
  if (const auto problem = validate(size))
    throw CLI::ValidationError("--size", problem->field + " " + problem->message);
  return size;
}

PixelRect parse_crop(const std::string& text) {
  std::array<std::uint32_t, 4> sides{};
  std::string_view rest = text;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const std::size_t comma = i + 1 < sides.size() ? rest.find(',') : rest.size();
    const auto side = whole_number(rest.substr(0, comma));
    if (!side || comma == std::string_view::npos)
      throw CLI::ValidationError("--crop", "wants x0,y0,x1,y1 in pixels, not " + text);
    sides[i] = *side;
    rest.remove_prefix(std::min(comma + 1, rest.size()));
  }
  return {.x0 = sides[0], .y0 = sides[1], .x1 = sides[2], .y1 = sides[3]};
}

std::filesystem::path default_output(const std::string& scene) {
  if (scene == "-") throw CLI::RequiredError("--output, where the scene is standard input,");
  return std::filesystem::path(scene).stem() += ".ppm";
}

}  // namespace

Parsed parse_arguments(int argc, char** argv) {
  Parsed parsed;
  Arguments& a = parsed.arguments;
  CLI::App app{"microtrace: renders a JSON or glTF scene, exactly and the same everywhere"};
  app.footer(kFooter);
  std::string output, size, crop, statistics;
  app.add_option("SCENE", a.scene, "scene file (.json, .gltf, .glb), or - for standard input")
      ->required();
  app.add_option("-o,--output", output,
                 "picture; its ending tells the kind (.ppm, .png, .exr, ...); - writes PPM to "
                 "standard output [SCENE's name with .ppm, in this folder]");
  app.add_option("--size", size, "WIDTHxHEIGHT in pixels [as the scene says, or 640x480]");
  app.add_option(
      "--crop", crop,
      "x0,y0,x1,y1: draw only the pixels from x0 to x1 - 1, y0 to y1 - 1, as they are in "
      "the whole picture; 0,0 is its upper left corner");
  app.add_option("--spp,--samples", a.samples,
                 "rays for each pixel, spread over it [1, through its centre]")
      ->check(CLI::Range(1U, kMaxSamples));
  app.add_option("-c,--camera", a.camera, "camera, by name or by number from 0 [the first]");
  app.add_option("-t,-j,--threads", a.threads, "threads [one for each processor]")
      ->check(CLI::Range(1U, 1024U));
  app.add_option("--ppm", a.ppm, "encoding of PPM files: binary (P6) or ascii (P3) [binary]")
      ->transform(CLI::Transformer(std::map<std::string, PpmEncoding>{
          {"binary", PpmEncoding::binary}, {"ascii", PpmEncoding::ascii}}))
      ->type_name("KIND");
  app.add_flag("--stats{text}", statistics,
               "time and memory used, to standard error; --stats=json for programs")
      ->check(CLI::IsMember({"text", "json"}));
  app.add_flag("--strict", a.strict, "warnings are errors: exit 3, no picture");
  app.add_flag("--validate", a.validate, "check the scene, draw nothing");
  app.add_flag("-q,--quiet", a.quiet, "no warnings and no progress bar");
  app.set_version_flag("--version", "microtrace " MICROTRACE_VERSION);
  try {
    app.parse(argc, argv);
    if (!size.empty()) a.size = parse_size(size);
    if (!crop.empty()) a.crop = parse_crop(crop);
    if (!statistics.empty())
      a.statistics = statistics == "json" ? Statistics::json : Statistics::text;
    a.output = output;
    if (output.empty() && !a.validate) a.output = default_output(a.scene);
  } catch (const CLI::ParseError& error) {
    parsed.exit_code = app.exit(error) == 0 ? 0 : static_cast<int>(ErrorKind::usage);
  }
  return parsed;
}

const Camera& choose_camera(const Scene& scene, const std::string& wanted) {
  if (wanted.empty()) return scene.cameras.at(0).camera;
  for (const NamedCamera& camera : scene.cameras) {
    if (camera.name == wanted) return camera.camera;
  }
  const auto index = whole_number(wanted);
  if (index && *index < scene.cameras.size()) return scene.cameras[*index].camera;
  std::string message = "--camera: there is no camera " + wanted + "; the scene has";
  for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
    message += i == 0 ? " " : ", ";
    message += std::to_string(i) + " (" + scene.cameras[i].name + ")";
  }
  throw Error(ErrorKind::usage, "", message);
}

}  // namespace microtrace::cli
