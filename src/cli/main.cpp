#include "base/printable.hpp"
#include "cli/arguments.hpp"
#include "cli/camera.hpp"
#include "cli/environment.hpp"
#include "cli/merge.hpp"
#include "cli/options/completion.hpp"
#include "cli/options/parse.hpp"
#include "cli/outputs.hpp"
#include "cli/picture.hpp"
#include "cli/signals.hpp"
#include "cli/statistics.hpp"
#include "cli/verdict.hpp"
#include "float_environment.hpp"

#include <microtrace/digest.hpp>
#include <microtrace/framing.hpp>
#include <microtrace/read_files.hpp>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

namespace {

using namespace microtrace;

/// What of surfaces the picture and its channels show.
SurfaceDetail detail_for(const cli::Arguments& arguments) {
  const std::vector<Aov>& aovs = arguments.aovs.exact;
  const bool shows_albedo = std::ranges::find(aovs, Aov::albedo) != aovs.end();
  const Aov* quantity = arguments.wanted ? std::get_if<Aov>(&*arguments.wanted) : nullptr;
  if (quantity != nullptr && *quantity != Aov::albedo && !shows_albedo) return SurfaceDetail::shape;
  if (!arguments.aovs.empty()) return SurfaceDetail::all;
  if (!arguments.wanted) return SurfaceDetail::usual;
  return arguments.wanted == cli::Subject(cli::Technique::flat) ? SurfaceDetail::color
                                                                : SurfaceDetail::all;
}

LoadOptions load_options(const cli::Arguments& arguments) {
  LoadOptions options = arguments.load;
  options.detail = detail_for(arguments);
  return options;
}

/// The camera of all frames, which frames all poses, where it is none of the scene's; in the
/// world's coordinates.
std::optional<PerspectiveCamera> framing_of(SceneFile& file, const cli::Arguments& arguments,
                                            const cli::FrameRange& frames) {
  LoadedScene posed = file.at(frames.time(frames.first));
  const cli::CameraOptions& camera_options = arguments.camera;
  const bool has_own = !posed.scene.cameras.empty() || !camera_options.camera.empty();
  if (camera_options.is_of_scene() && has_own) return std::nullopt;
  Framing framing(camera_options.view(), arguments.size.value_or(posed.scene.size));
  framing.add(posed.scene);
  for (std::uint32_t frame = frames.first + 1; frame <= frames.last; ++frame) {
    posed = file.at(frames.time(frame));
    framing.add(posed.scene);
  }
  PerspectiveCamera camera = cli::camera_of(framing, camera_options);
  camera.pose.position += framing.origin();
  return camera;
}

/// The file is read once. The exit code.
int run_frames(cli::Arguments arguments, const cli::FrameRange& frames) {
  using cli::frame_path;
  cli::Stopwatch watch;
  LoadTimes times;
  LoadOptions options = load_options(arguments);
  options.times = &times;
  const ReadFiles inputs;
  SceneFile file(arguments.scene, options);
  cli::apply_defaults(arguments, file.format());
  const std::string output = arguments.output.string(), sidecar = arguments.sidecar.string();
  const auto progress = cli::progress_of(arguments, frames.count());
  std::optional<PerspectiveCamera> framing;
  if (!arguments.validate) {
    cli::check_outputs(arguments, frame_path(output, frames.first),
                       frame_path(sidecar, frames.first));
    framing = framing_of(file, arguments, frames);
  }
  cli::Warnings log(arguments);
  std::vector<Diagnostic> light_warnings;
  const auto environment =
      cli::load_environment(arguments.environment, light_warnings, *arguments.load.memory);
  log.report(light_warnings);
  RenderCache cache;
  for (std::uint32_t frame = frames.first; frame <= frames.last; ++frame) {
    auto [scene, warnings] = file.at(frames.time(frame));
    log.report(warnings);
    cli::apply_environment(scene, environment, arguments.environment);
    const ImageSize size = arguments.size.value_or(scene.size);
    Camera camera;
    if (framing) {
      PerspectiveCamera still = *framing;
      still.pose.position -= scene.origin;
      camera = still;
    } else {
      camera = cli::choose_camera(scene, arguments.camera, size);
    }
    watch.loaded(std::exchange(times, {}));
    if (arguments.validate) continue;
    if (frame == frames.first) cli::check_frames(inputs, frames, output, sidecar);

    const cli::PictureFiles files{.picture = frame_path(output, frame),
                                  .sidecar = frame_path(sidecar, frame)};
    const auto tell = [&](double share) {
      if (progress) progress((frame - frames.first + share) / frames.count());
    };
    cli::make_picture(std::move(scene), camera, size, arguments, files, cache, watch, log, tell);
  }
  return arguments.validate ? log.print_verdict(arguments.scene) : 0;
}

/// The exit code.
int run(cli::Arguments arguments) {
  MemoryBudget memory(arguments.memory_limit.value_or(default_memory_limit()));
  arguments.load.memory = &memory;
  if (arguments.frames) return run_frames(arguments, *arguments.frames);
  cli::Stopwatch watch;
  LoadTimes times;
  LoadOptions options = load_options(arguments);
  options.times = &times;
  std::optional<ReadDigest> digest;
  if (arguments.sampling.uses_files()) digest.emplace();
  const ReadFiles inputs;
  SceneFile file(arguments.scene, options);
  cli::apply_defaults(arguments, file.format());
  auto [scene, warnings] = file.at(arguments.load.time);
  const auto environment =
      cli::load_environment(arguments.environment, warnings, *arguments.load.memory);
  cli::Warnings log(arguments);
  log.report(warnings);
  cli::apply_environment(scene, environment, arguments.environment);
  const ImageSize size = arguments.size.value_or(scene.size);
  const Camera camera = cli::choose_camera(scene, arguments.camera, size);
  watch.loaded(times);
  if (arguments.validate) return log.print_verdict(arguments.scene);

  cli::check_outputs(arguments, arguments.output, arguments.sidecar);
  cli::refuse_to_write_over(inputs, {{"--checkpoint", arguments.sampling.checkpoint}});
  cli::PictureFiles files{.picture = arguments.output, .sidecar = arguments.sidecar};
  std::optional<cli::SampleFiles> samples;
  if (arguments.sampling.uses_files()) files.samples = &samples.emplace(arguments, digest->value());
  if (samples) log.report(samples->warnings());
  cli::refuse_to_write_over(inputs,
                            {{"--output", arguments.output}, {"--sidecar", arguments.sidecar}});
  RenderCache cache;
  cli::make_picture(std::move(scene), camera, size, arguments, files, cache, watch, log,
                    cli::progress_of(arguments));
  return 0;
}

/// Does the work, and says what went wrong with it.
template <class Work>
int exit_code_of(const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return static_cast<int>(error.kind());
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "error: out of memory\n");
    return static_cast<int>(ErrorKind::limit);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", printable(error.what()).c_str());
    return static_cast<int>(ErrorKind::internal);
  }
}

bool is_merge(int argc, char** argv) {
  return argc > 1 && std::string_view(argv[1]) == "merge";
}

}  // namespace

int main(int argc, char** argv) {
  const FloatEnvironment environment;
  cli::handle_signals();
  if (cli::is_completion(argc, argv)) return cli::print_completion(argc, argv);
  if (is_merge(argc, argv)) {
    const cli::Parsed merge = cli::parse_arguments(cli::Command::merge, argc - 1, argv + 1);
    if (merge.exit_code) return *merge.exit_code;
    return exit_code_of([&] {
      cli::merge_samples(merge.arguments);
      return 0;
    });
  }
  const cli::Parsed parsed = cli::parse_arguments(cli::Command::render, argc, argv);
  if (parsed.exit_code) return *parsed.exit_code;
  if (parsed.arguments.max_time) cli::end_after(*parsed.arguments.max_time);
  return exit_code_of([&] {
    const cli::Arguments& arguments = parsed.arguments;
    try {
      return run(arguments);
    } catch (const Error& error) {
      if (arguments.validate) cli::print_refused(arguments.scene, error.kind());
      throw;
    }
  });
}
