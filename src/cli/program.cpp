#include "cli/program.hpp"

#include "base/printable.hpp"
#include "cli/arguments.hpp"
#include "cli/compare.hpp"
#include "cli/dataset/dataset.hpp"
#include "cli/explain.hpp"
#include "cli/merge.hpp"
#include "cli/options/completion.hpp"
#include "cli/options/help.hpp"
#include "cli/options/parse.hpp"
#include "cli/pictures/camera.hpp"
#include "cli/pictures/environment.hpp"
#include "cli/pictures/exposure.hpp"
#include "cli/pictures/output_paths.hpp"
#include "cli/pictures/render_picture.hpp"
#include "cli/pictures/sequence.hpp"
#include "cli/pictures/shutter.hpp"
#include "cli/report/statistics.hpp"
#include "cli/report/validation_result.hpp"
#include "cli/signals.hpp"
#include "cli/view/view.hpp"
#include "float_environment.hpp"

#include <microtrace/denoise.hpp>
#include <microtrace/digest.hpp>
#include <microtrace/read_files.hpp>

#include <array>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <optional>
#include <string_view>
#include <utility>

namespace microtrace {
namespace {

/// Reads the scene file, renders and writes its pictures. Returns the exit code.
int render_pictures(cli::Arguments arguments) {
  MemoryBudget memory(arguments.memory_limit.value_or(default_memory_limit()));
  cli::Stopwatch watch;
  LoadTimes times;
  arguments.load.memory = &memory;
  arguments.load.times = &times;
  arguments.load.detail = cli::surface_detail(arguments);
  std::optional<ReadDigest> digest;
  std::optional<std::uint64_t> scene_files;
  if (arguments.sampling.uses_files()) digest.emplace();
  const ReadFiles inputs;
  SceneFile file(arguments.scene, arguments.load);
  cli::apply_defaults(arguments, file.format());

  const cli::Sequence sequence(arguments);
  const auto progress = cli::progress_of(arguments, sequence.count());
  std::optional<PerspectiveCamera> framing;
  if (!arguments.validate) {
    cli::check_outputs(arguments, sequence);
    framing = cli::frame_all(file, sequence, arguments);
  }
  cli::Warnings log(arguments);
  std::optional<Environment> environment;
  std::optional<cli::SampleFiles> samples;
  std::optional<Denoiser> denoiser;
  if (arguments.denoises && !arguments.sampling.shard && !arguments.validate) denoiser.emplace();
  std::optional<cli::DisplayServer> viewer;
  if (arguments.display_server && !arguments.validate)
    viewer.emplace(*arguments.display_server, arguments.quiet);
  cli::Tables tables;
  for (std::uint32_t index = 0; index < sequence.count(); ++index) {
    const bool is_last = !arguments.frames && !arguments.shutter;
    LoadedScene loaded = is_last ? file.last(sequence.time(index)) : file.at(sequence.time(index));
    Scene& scene = loaded.scene;
    if (index == 0) {
      environment = cli::load_environment(arguments.environment, loaded.warnings, memory);
      if (arguments.frames && !arguments.validate)
        arguments.display = cli::with_exposure_of_frames(file, arguments, environment, framing);
    }
    log.report(loaded.warnings);
    cli::apply_environment(scene, environment, arguments.environment);
    const ImageSize size = arguments.size.value_or(scene.size);
    const Camera camera = framing ? cli::in_coordinates_of(scene, *framing)
                                  : cli::choose_camera(scene, arguments.camera, size);
    watch.loaded(std::exchange(times, {}));
    if (arguments.validate) continue;

    if (index == 0) {
      cli::check_paths(inputs, sequence);
      if (digest) scene_files = digest->value();  // without the checkpoints, which are read next
    }
    if (scene_files)
      log.report(samples.emplace(arguments, sequence, index, *scene_files).warnings());
    cli::check_no_input_is_overwritten(
        inputs, {{"--output", sequence.picture(index)}, {"--sidecar", sequence.sidecar(index)}});
    const cli::PictureFiles files{.picture = sequence.picture(index),
                                  .sidecar = sequence.sidecar(index),
                                  .samples = samples ? &*samples : nullptr,
                                  .viewer = viewer ? &*viewer : nullptr,
                                  .denoiser = denoiser ? &*denoiser : nullptr};
    const auto report_progress = [&](double fraction) {
      if (progress) progress((index + fraction) / sequence.count());
    };
    std::optional<Shutter> shutter = cli::shutter_of({.file = file,
                                                      .arguments = arguments,
                                                      .environment = environment,
                                                      .tables = tables,
                                                      .time = sequence.time(index).value_or(0),
                                                      .size = size},
                                                     scene, camera);
    cli::render_picture(std::move(scene), camera, size, arguments, files, std::move(shutter),
                        tables, watch, log, report_progress);
    times = {};  // the scenes of the shutter are loaded while the picture is rendered
  }
  return arguments.validate ? log.print_result(arguments.scene) : 0;
}

/// Runs a command and returns its exit code. Prints its error, if any.
template <class Work>
int exit_code_of(const Work& work) {
  try {
    return work();
  } catch (const cli::Interruption& interruption) {
    return 128 + interruption.signal;
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

/// Applies the options that end a run early.
void limit_run(const cli::Arguments& arguments) {
  if (arguments.parent) cli::end_with_parent(*arguments.parent);
  if (arguments.max_time) cli::end_after(*arguments.max_time);
}

/// A command that the user selects by its name as the first argument.
struct NamedCommand {
  cli::Command command;
  int (*run)(const cli::Arguments&);  ///< returns the exit code
};

/// Calls a command that succeeds unless it throws.
template <void (*command)(const cli::Arguments&)>
int succeed(const cli::Arguments& arguments) {
  command(arguments);
  return 0;
}

constexpr std::array kNamedCommands{
    NamedCommand{cli::Command::merge, succeed<cli::merge_samples>},
    NamedCommand{cli::Command::dataset, succeed<cli::write_dataset>},
    NamedCommand{cli::Command::verify, succeed<cli::verify_dataset>},
    NamedCommand{cli::Command::explain, succeed<cli::explain_ray>},
    NamedCommand{cli::Command::compare, cli::compare_files},
    NamedCommand{cli::Command::view, succeed<cli::view_scene>},
};

}  // namespace

int cli::run_program(int argc, char** argv) {
  const FloatEnvironment environment;
  cli::handle_signals();
  if (cli::is_completion(argc, argv)) return cli::print_completion(argc, argv);
  for (const NamedCommand& named : kNamedCommands) {
    if (argc < 2 || argv[1] != cli::name_of(named.command)) continue;
    const cli::Parsed parsed = cli::parse_arguments(named.command, argc - 1, argv + 1);
    if (parsed.exit_code) return *parsed.exit_code;
    return exit_code_of([&] {
      limit_run(parsed.arguments);
      return named.run(parsed.arguments);
    });
  }
  const cli::Parsed parsed = cli::parse_arguments(cli::Command::render, argc, argv);
  if (parsed.exit_code) return *parsed.exit_code;
  return exit_code_of([&] {
    const cli::Arguments& arguments = parsed.arguments;
    limit_run(arguments);
    try {
      return render_pictures(arguments);
    } catch (const Error& error) {
      if (arguments.validate) cli::print_refusal(arguments.scene, error.kind());
      throw;
    }
  });
}

}  // namespace microtrace
