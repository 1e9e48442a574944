#include "cli/pictures/render_pictures.hpp"

#include "cli/camera.hpp"
#include "cli/pictures/environment.hpp"
#include "cli/pictures/exposure.hpp"
#include "cli/pictures/output_paths.hpp"
#include "cli/pictures/render_picture.hpp"
#include "cli/pictures/sequence.hpp"
#include "cli/pictures/shutter.hpp"
#include "cli/report/statistics.hpp"
#include "cli/report/validation_result.hpp"

#include <microtrace/denoise.hpp>
#include <microtrace/digest.hpp>
#include <microtrace/error.hpp>
#include <microtrace/read_files.hpp>

#include <cstdint>
#include <functional>
#include <optional>
#include <utility>

namespace microtrace::cli {
namespace {

/// Renders the pictures of one run, whose inputs are read once.
class PictureRun {
 public:
  /// Reads the scene file and checks the outputs. Throws Error.
  explicit PictureRun(const Arguments& arguments)
      : arguments_(arguments),
        memory_(arguments.memory_limit.value_or(default_memory_limit())),
        sequence_(arguments_),
        log_(arguments_) {
    arguments_.load.memory = &memory_;
    arguments_.load.times = &times_;
    arguments_.load.detail = surface_detail(arguments_);
    if (arguments_.sampling.uses_files()) digest_.emplace();
    file_.emplace(arguments_.scene, arguments_.load);
    apply_defaults(arguments_, file_->format());
    progress_ = progress_of(arguments_, sequence_.count());
    if (!arguments_.validate) prepare_outputs();
  }

  /// Returns the exit code.
  int run() {
    for (std::uint32_t index = 0; index < sequence_.count(); ++index) {
      Scene scene = load(index);
      const ImageSize size = arguments_.size.value_or(scene.size);
      const Camera camera = framing_ ? in_coordinates_of(scene, *framing_)
                                     : choose_camera(scene, arguments_.camera, size);
      watch_.loaded(std::exchange(times_, {}));
      if (!arguments_.validate) render(std::move(scene), camera, size, index);
    }
    return arguments_.validate ? log_.print_result(arguments_.scene) : 0;
  }

 private:
  void prepare_outputs() {
    check_outputs(arguments_, sequence_);
    framing_ = frame_all(*file_, sequence_, arguments_);
    if (arguments_.denoises && !arguments_.sampling.shard) denoiser_.emplace();
    if (arguments_.display_server)
      display_server_.emplace(*arguments_.display_server, arguments_.quiet);
  }

  /// Returns the scene of a picture in its environment, and reports the warnings about it.
  Scene load(std::uint32_t index) {
    const bool is_last = !arguments_.frames && !arguments_.shutter;
    LoadedScene loaded =
        is_last ? file_->last(sequence_.time(index)) : file_->at(sequence_.time(index));
    if (index == 0) {
      environment_ = load_environment(arguments_.environment, loaded.warnings, memory_);
      if (arguments_.frames && !arguments_.validate)
        arguments_.display = with_exposure_of_frames(*file_, arguments_, environment_, framing_);
    }
    log_.report(loaded.warnings);
    apply_environment(loaded.scene, environment_, arguments_.environment);
    return std::move(loaded.scene);
  }

  void render(Scene scene, const Camera& camera, ImageSize size, std::uint32_t index) {
    if (index == 0) {
      check_paths(inputs_, sequence_);
      if (digest_) scene_files_ = digest_->value();  // without the checkpoints, which are read next
    }
    if (const auto warning = ground_warning(arguments_, scene)) log_.report({*warning});
    if (scene_files_)
      log_.report(samples_.emplace(arguments_, sequence_, index, *scene_files_).warnings());
    const PictureFiles files{.picture = sequence_.picture(index),
                             .sidecar = sequence_.sidecar(index),
                             .samples = samples_ ? &*samples_ : nullptr,
                             .display_server = display_server_ ? &*display_server_ : nullptr,
                             .denoiser = denoiser_ ? &*denoiser_ : nullptr};
    check_no_input_is_overwritten(inputs_,
                                  {{"--output", files.picture}, {"--sidecar", files.sidecar}});
    const auto report_progress = [&](double fraction) {
      if (progress_) progress_((index + fraction) / sequence_.count());
    };
    std::optional<Shutter> shutter = shutter_of({.file = *file_,
                                                 .arguments = arguments_,
                                                 .environment = environment_,
                                                 .tables = tables_,
                                                 .time = sequence_.time(index).value_or(0),
                                                 .size = size},
                                                scene, camera);
    render_picture(std::move(scene), camera, size, arguments_, files, std::move(shutter), tables_,
                   watch_, log_, report_progress);
    times_ = {};  // the scenes of the shutter are loaded while the picture is rendered
  }

  Arguments arguments_;
  MemoryBudget memory_;
  Stopwatch watch_;
  LoadTimes times_;
  std::optional<ReadDigest> digest_;
  std::optional<std::uint64_t> scene_files_;  ///< digest; absent without files of samples
  const ReadFiles inputs_;
  std::optional<SceneFile> file_;
  const Sequence sequence_;
  std::function<void(double)> progress_;      ///< may be empty
  std::optional<PerspectiveCamera> framing_;  ///< of all frames
  Warnings log_;
  std::optional<Environment> environment_;  ///< of --env
  std::optional<SampleFiles> samples_;
  std::optional<Denoiser> denoiser_;
  std::optional<DisplayServer> display_server_;
  Tables tables_;
};

}  // namespace

int render_pictures(const Arguments& arguments) {
  try {
    return PictureRun(arguments).run();
  } catch (const Error& error) {
    if (arguments.validate) print_refusal(arguments.scene, error.kind());
    throw;
  }
}

}  // namespace microtrace::cli
