#pragma once
/// The parsed command line.

#include "cli/options/values.hpp"
#include "cli/pictures/frames.hpp"

#include <microtrace/annotations.hpp>
#include <microtrace/defaults.hpp>
#include <microtrace/film.hpp>
#include <microtrace/io.hpp>
#include <microtrace/math.hpp>
#include <microtrace/path.hpp>
#include <microtrace/ray.hpp>
#include <microtrace/render.hpp>

#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace microtrace::cli {

/// Camera options. At most one of camera, orbit and eye is set.
struct CameraOptions {
  std::string camera;              ///< name or index of a scene's camera; empty: the first
  std::string place = "--camera";  ///< what named `camera`, for messages
  std::optional<OrbitView> orbit{};
  std::optional<DVec3> eye{};
  std::optional<DVec3> target{};                 ///< absent: the center of the scene's bounding box
  DVec3 up{0, 1, 0};                             ///< up vector for `eye`
  std::optional<double> vertical_fov{};          ///< degrees; for `orbit` and `eye`
  std::optional<double> lens_radius{}, focus{};  ///< replace those of the camera

  [[nodiscard]] bool is_of_scene() const { return !orbit && !eye; }
  /// Returns the view of --view, or the default view, with the angle of --fov.
  [[nodiscard]] View view() const;
};

struct EnvironmentOptions {
  std::optional<EnvironmentSource> source{};
  std::optional<double> rotation{};  ///< degrees
  std::optional<float> intensity{};
  std::optional<Background> background{};

  [[nodiscard]] bool is_transparent() const {
    return background && background->kind == Background::Kind::transparent;
  }
  [[nodiscard]] bool shows_environment() const {
    return background && background->kind == Background::Kind::environment;
  }
};

/// The scenes for which automatic_exposure() determines an exposure that is not given.
enum class AutomaticExposure { never, for_lights, always };

/// Conversion of light to 8-bit formats. The integrator determines the values that are absent.
struct DisplayOptions {
  std::optional<double> exposure{};  ///< stops
  AutomaticExposure automatic = AutomaticExposure::never;
  std::optional<ToneMap> tone_map{};
};

/// Values of other options under one name.
struct Quality {
  std::string_view name;
  std::uint32_t samples;  ///< per pixel, at most
  double target_error;    ///< 0 if there is no target
};

inline constexpr std::array kQualities{
    Quality{.name = "draft", .samples = 16, .target_error = 0},
    Quality{.name = "good", .samples = 256, .target_error = 0.03},
    Quality{.name = "final", .samples = 4096, .target_error = 0.01},
};

struct SamplingOptions {
  std::uint32_t samples = 0;         ///< samples per pixel; 0 until apply_defaults()
  const Quality* quality = nullptr;  ///< null without --quality
  PixelFilter filter = PixelFilter::box;
  std::uint32_t seed = 0;
  double target_error = 0;                                      ///< 0 if there is no target
  double time_limit = std::numeric_limits<double>::infinity();  ///< seconds
  std::optional<Shard> shard{};                 ///< renders only these samples, and no picture
  std::filesystem::path checkpoint{};           ///< empty if no checkpoint is written
  std::vector<std::filesystem::path> resume{};  ///< checkpoints to continue
  double save_every = 60;                       ///< seconds
  bool is_progressive = false;

  /// Returns the range of the shard's samples; absent without --shard.
  [[nodiscard]] std::optional<SampleRange> range() const;
  /// Returns true if samples are read from files or written while rendering.
  [[nodiscard]] bool uses_files() const {
    return !checkpoint.empty() || !resume.empty() || is_progressive;
  }
  [[nodiscard]] bool needs_passes() const {
    return uses_files() || target_error > 0 || time_limit < std::numeric_limits<double>::infinity();
  }
};

/// A format in which a data set stores its views.
enum class DatasetFormat { png, exr, npz, coco, bop };

struct DatasetOptions {
  std::string views{};  ///< a file or a generator; empty: one view, or the frames
  std::vector<DatasetFormat> formats{DatasetFormat::png};
  std::string name = "{view:06d}";
  CocoOptions coco{};
  double depth_scale = 0.1;  ///< millimeters per step of BOP's depths
  std::optional<Shard> shard{};
  std::uint32_t redraw = 1;  ///< number of views that `verify` renders again
  /// The options on which the files depend, and their command line.
  std::string identity{};
  std::vector<std::string> command_line{};
};

struct ExplainArguments {
  std::optional<DVec2> pixel{};  ///< as in RayGenerator
  std::optional<WorldRay> ray{};
  bool is_json = false;
  bool is_all = false;
};

struct CompareArguments {
  std::vector<std::filesystem::path> pictures{};
  double threshold = 0;
  bool is_json = false;
};

struct ViewOptions {
  std::uint16_t port = 0;  ///< 0: any free port
  bool opens_browser = true;
  std::string other_scene{};   ///< a scene file to compare with; may be empty
  std::string allowed_host{};  ///< NAME or NAME:PORT of a proxy's address
  /// The given options that change the picture, as words of a command line.
  std::vector<std::string> words{};
};

enum class Statistics { none, text, json };
enum class Progress { none, bar, json };

struct Arguments {
  std::string scene;              ///< a file, or "-" for standard input
  std::filesystem::path output;   ///< a file, or "-" for standard output
  std::filesystem::path sidecar;  ///< a file, or "-" for standard output; empty if there is none
  LoadOptions load{};
  std::optional<FrameRange> frames{};  ///< output and sidecar are then patterns
  /// The times of motion blur, relative to the time of the picture.
  std::optional<ShutterTimes> shutter{};
  std::optional<ImageSize> size{};
  std::optional<PixelRect> crop{};
  EnvironmentOptions environment{};
  DisplayOptions display{};
  bool denoises = false;
  SamplingOptions sampling{};
  /// Absent until choose_integrator() unless --integrator is given.
  std::optional<IntegratorOptions> integrator{};
  PathOptions path{};  ///< options of the path integrator
  Channels aovs{};
  CameraOptions camera{};
  std::optional<NetworkAddress> display_server{};
  unsigned threads = 0;              ///< 0: default_threads()
  std::optional<double> max_time{};  ///< seconds for the whole run
  /// Ends the run with its parent process, which has this id; 0: the current parent.
  std::optional<std::uint32_t> parent{};
  std::optional<std::uint64_t> memory_limit{};  ///< bytes; absent: default_memory_limit()
  PpmEncoding ppm = PpmEncoding::binary;
  Statistics statistics = Statistics::none;
  Progress progress = Progress::bar;
  bool quiet = false;
  bool verbose = false;
  bool strict = false;
  bool validate = false;
  /// The options on which samples depend, in the form of Checkpoint::identity.
  std::string identity{};

  /// Requires choose_integrator().
  [[nodiscard]] bool is_path_traced() const {
    return std::holds_alternative<PathOptions>(*integrator);
  }

  // For the command merge only:
  std::vector<std::filesystem::path> checkpoints{};
  bool allows_missing_samples = false;

  // For the commands dataset and verify only:
  DatasetOptions dataset{};

  // For the command explain only:
  ExplainArguments explain{};

  // For the command compare only:
  CompareArguments compare{};

  // For the command view only:
  ViewOptions view{};
};

/// Sets the integrator to the library's default for scenes of this format if it is absent.
void choose_integrator(Arguments& arguments, SceneFormat format);

/// Sets options that are absent to the library's defaults for scenes of this format. Throws Error
/// (usage) if given options contradict these defaults.
void apply_defaults(Arguments& arguments, SceneFormat format);

/// Returns the surface properties that the picture and its channels need. May be called before
/// apply_defaults().
[[nodiscard]] SurfaceDetail surface_detail(const Arguments& arguments);

}  // namespace microtrace::cli
