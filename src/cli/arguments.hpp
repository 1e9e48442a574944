#pragma once
/// The command line.

#include "cli/arguments_camera.hpp"
#include "cli/arguments_light.hpp"
#include "cli/arguments_sampling.hpp"
#include "cli/frames.hpp"
#include "cli/option_values.hpp"

#include <microtrace/io.hpp>
#include <microtrace/path.hpp>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace microtrace::cli {

enum class Statistics { none, text, json };
enum class Progress { none, bar, json };

struct Arguments {
  std::string scene;             ///< a file, or "-" for standard input
  std::filesystem::path output;  ///< a file, or "-" for standard output
  LoadOptions load{};
  std::optional<FrameRange> frames{};  ///< output and sidecar are then patterns
  std::optional<ImageSize> size{};
  std::optional<PixelRect> crop{};
  Surroundings surroundings{};
  Exposure exposure{};
  Sampling sampling{};
  std::optional<Subject> wanted{};       ///< what --integrator names
  Subject integrator = Technique::flat;  ///< as settle() has it
  PathOptions path{};
  Channels aovs{};
  std::filesystem::path sidecar;  ///< a file, "-" for standard output, or none
  Viewpoint viewpoint{};
  unsigned threads = 0;
  std::optional<double> max_time{};             ///< seconds for the whole run
  std::optional<std::uint64_t> memory_limit{};  ///< bytes; nothing: default_memory_limit()
  PpmEncoding ppm = PpmEncoding::binary;
  Statistics statistics = Statistics::none;
  Progress progress = Progress::bar;
  bool quiet = false;
  bool verbose = false;
  bool strict = false;
  bool validate = false;
};

/// Reads the command line. Prints help or version to standard output, and usage errors to standard
/// error; then the exit code stands in `exit_code` and there is nothing to do.
struct Parsed {
  Arguments arguments;
  std::optional<int> exit_code{};
};
[[nodiscard]] Parsed parse_arguments(int argc, char** argv);

/// An option as --help describes it.
struct OptionHelp {
  std::vector<std::string> names{};  ///< with their dashes, short ones first
  bool has_value = false;            ///< one must follow
  std::string value{};               ///< its kind, in the words of --help
  std::string text{};
};
/// All options of parse_arguments().
[[nodiscard]] std::vector<OptionHelp> list_options();

/// Fills in what is left to the scene's format: glTF assets are drawn with light, over grey, JSON
/// scenes flat. Throws Error (usage) where options make no sense then.
void settle(Arguments& arguments, SceneFormat format);

/// That of the settled arguments.
[[nodiscard]] std::unique_ptr<Integrator> make_integrator(const Arguments& arguments);

}  // namespace microtrace::cli
