#include "cli/pictures/render_picture.hpp"

#include "base/memory_account.hpp"
#include "base/system/processors.hpp"
#include "base/text/printable.hpp"
#include "cli/pictures/environment.hpp"
#include "cli/pictures/exposure.hpp"
#include "cli/pictures/output_paths.hpp"
#include "cli/report/progress_bar.hpp"
#include "cli/report/scene_summary.hpp"
#include "cli/report/unusual_counts.hpp"
#include "cli/report/written_files.hpp"
#include "cli/signals.hpp"
#include "scene/mesh/mesh_memory.hpp"

#include <microtrace/error.hpp>
#include <microtrace/render.hpp>
#include <microtrace/sidecar.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <optional>
#include <string>
#include <utility>

namespace microtrace::cli {
namespace {

/// Returns true if the id channel is rendered only for the sidecar, which counts each id's pixels.
bool needs_ids_for_sidecar_only(const Arguments& arguments, const PictureFiles& files) {
  return !files.sidecar.empty() &&
         std::ranges::find(arguments.aovs.exact, Aov::id) == arguments.aovs.exact.end();
}

void save_picture(const Arguments& arguments, const Scene& scene, const Camera& camera,
                  const std::optional<ShutterTimes>& shutter, Film& film,
                  const PictureFiles& files) {
  Sidecar sidecar{.path = files.sidecar, .text = {}};
  if (!files.sidecar.empty())
    sidecar.text =
        describe_picture(scene, camera, film, files.picture.filename().string(), shutter);
  if (needs_ids_for_sidecar_only(arguments, files))
    std::erase_if(film.channels, [](const Channel& c) { return c.name.starts_with("id."); });
  save_image(film, files.picture, arguments.ppm, files.sidecar.empty() ? nullptr : &sidecar);
}

/// Returns true if lines about written files are printed. If JSON is requested, standard error
/// contains only JSON.
bool reports_files(const Arguments& arguments) {
  return !arguments.quiet && arguments.statistics != Statistics::json &&
         arguments.progress != Progress::json;
}

/// Returns the break-even growth of the tree's cost: the growth at which slower rays lose as much
/// time as refitting the previous frame's tree saves. Refitting saves about 250 ns per primitive.
/// Rays take about 500 ns per sample, half of it in the tree.
double max_cost_growth_of(const Scene& scene, ImageSize size, std::uint32_t samples) {
  std::size_t primitives = 0;
  for (const ObjectRun& run : scene.objects.runs()) primitives += primitive_count(run);
  const auto pixels = static_cast<double>(std::uint64_t{size.width} * size.height);
  return 1 + std::min(1.0, static_cast<double>(primitives) / (pixels * samples));
}

/// Wraps `progress` for RenderOptions. Only a delayed signal cancels the rendering.
std::function<bool(double)> shown_by(const std::function<void(double)>& progress) {
  return [&progress](double share) {
    if (progress) progress(share);
    return DelayedSignals::received() == 0;
  };
}

/// Returns the passes of the options; nothing if they don't need passes.
std::optional<Passes> passes_of(const SamplingOptions& sampling, const Integrator& integrator,
                                const DisplayOptions& display, const PictureFiles& files) {
  if (files.samples != nullptr) {
    Film shown({.width = 1, .height = 1});
    shown.display = integrator.display(shown);
    apply_display(shown, display);
    return files.samples->passes(shown.display);
  }
  if (!sampling.needs_passes()) return std::nullopt;
  return Passes{.target_error = sampling.target_error, .time_limit = sampling.time_limit};
}

/// Shows the picture after passes if it is rendered in passes.
void show_passes(RenderOptions& options, DisplayServer& server, const std::string& name) {
  if (!options.passes && options.integrator->is_random()) options.passes.emplace();
  if (!options.passes) return;
  options.passes->after_each = [&server, name, transparent = options.transparent,
                                before = options.passes->after_each](const SampleSums& sums) {
    if (before) before(sums);
    const Film::Alpha alpha = transparent ? Film::Alpha::premultiplied : Film::Alpha::none;
    if (server.is_due()) server.show(name, develop(sums, alpha));
  };
}

struct SavedFilm {
  Film film;
  std::exception_ptr failure{};  ///< why the samples could not be saved
};

/// Renders the picture and saves its samples. Signals are delayed once there are samples. After a
/// delayed signal, saves the samples of all complete passes and throws Interruption.
SavedFilm render_and_save(const PreparedScene& scene, const Camera& camera, ImageSize size,
                          RenderOptions options, const Arguments& arguments,
                          const PictureFiles& files) {
  const auto draw = [&] {
    if (files.denoiser != nullptr) return files.denoiser->render(scene, camera, size, options);
    return render(scene, camera, size, options);
  };
  if (files.samples == nullptr || files.samples->checkpoint().empty()) return {.film = draw()};
  std::optional<Film> film;
  std::exception_ptr failure;
  {
    // Until then, there is nothing to save. Preparing the scene's light may take long.
    std::optional<DelayedSignals> delay;
    if (options.passes) {
      options.passes->after_each = [&delay, then = options.passes->after_each](const auto& sums) {
        if (!delay) delay.emplace();
        if (then) then(sums);
      };
    }
    try {
      film = draw();
      if (!delay) delay.emplace();
      files.samples->keep(*film);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::canceled) {
        files.samples->save();
        throw;
      }
    }
    try {
      files.samples->save();
    } catch (const Error&) {
      // The picture can still be written.
      if (!film || arguments.sampling.shard || DelayedSignals::received() != 0) throw;
      failure = std::current_exception();
    }
  }
  if (film && DelayedSignals::received() == 0)
    return {.film = std::move(*film), .failure = failure};
  if (!arguments.quiet && files.samples->has_samples()) {
    clear_progress_bar();
    std::fprintf(stderr, "interrupted: the samples are saved in %s\n",
                 printable(files.samples->checkpoint().string()).c_str());
  }
  throw Interruption{DelayedSignals::received()};
}

FilmContents contents_of(const Arguments& arguments, std::optional<ImageSize> size) {
  if (const auto& crop = arguments.crop) {
    const bool is_valid = crop->x0 < crop->x1 && crop->y0 < crop->y1;  // otherwise refused later
    size = is_valid ? std::optional(crop->size()) : std::nullopt;
  }
  return {.alpha = arguments.environment.is_transparent(),
          .channels = !arguments.aovs.empty(),
          .size = size};
}

/// Returns the options of a picture without the function that reports progress, times, counts and
/// passes.
RenderOptions options_of(const Arguments& arguments, const Integrator& integrator,
                         const PictureFiles& files) {
  RenderOptions options{
      .threads = thread_count(arguments.threads),
      .integrator = &integrator,
      .samples = arguments.sampling.samples,
      .filter = arguments.sampling.filter,
      .seed = arguments.sampling.seed,
      .memory = arguments.load.memory,
      .crop = arguments.crop,
      .aovs = arguments.aovs.exact,
      .sampled_aovs = arguments.aovs.sampled,
      .transparent = arguments.environment.is_transparent(),
  };
  // Merging the shards denoises the picture.
  if (arguments.denoises && arguments.sampling.shard) add_denoise_features(options);
  if (needs_ids_for_sidecar_only(arguments, files)) options.aovs.push_back(Aov::id);
  return options;
}

}  // namespace

std::function<void(double)> progress_of(const Arguments& arguments, std::uint32_t pictures) {
  if (arguments.progress == Progress::json) return progress_lines();
  return arguments.quiet || arguments.progress == Progress::none ? nullptr : progress_bar(pictures);
}

void check_outputs(const Arguments& arguments, const Sequence& sequence) {
  const std::filesystem::path output = sequence.picture(0), sidecar = sequence.sidecar(0);
  const std::filesystem::path checkpoint = sequence.checkpoint(0);
  if (!checkpoint.empty()) check_checkpoint_path(checkpoint);
  if (arguments.sampling.shard) return;
  if (arguments.sampling.is_progressive && output == "-")
    throw Error(ErrorKind::usage, "standard output",
                "can't be rewritten by --progressive; name a file with -o");
  check_outputs_differ(
      {{"--output", output}, {"--sidecar", sidecar}, {"--checkpoint", checkpoint}});
  check_image_path(output, contents_of(arguments, arguments.size));
  if (!sidecar.empty()) check_sidecar_path(sidecar, output);
}

void render_picture(Scene scene, const Camera& camera, ImageSize size, const Arguments& arguments,
                    const PictureFiles& files, std::optional<Shutter> shutter, Tables& tables,
                    Stopwatch& watch, Warnings& warnings,
                    const std::function<void(double)>& progress) {
  // Otherwise check_outputs() knew the size.
  if (!arguments.sampling.shard && !arguments.size && !arguments.crop)
    check_image_path(files.picture, contents_of(arguments, size));
  if (arguments.verbose) print_scene_summary(arguments, scene, size);
  const std::unique_ptr<Integrator> integrator = make_integrator(*arguments.integrator);
  RenderTimes times;
  RenderCounts counts;
  RenderOptions options = options_of(arguments, *integrator, files);
  options.progress = shown_by(progress);
  options.times = &times;
  options.counts = &counts;
  options.shutter = std::move(shutter);
  const auto start = std::chrono::steady_clock::now();
  // SceneFile no longer counts the memory of this scene once it makes the shutter's scenes.
  MemoryAccount still(options.memory);
  if (options.shutter) still.take(memory_of(scene), "the scene at the time of the picture");
  const double max_cost_growth = max_cost_growth_of(scene, size, options.samples);
  const PreparedScene prepared(std::move(scene), {.threads = options.threads,
                                                  .memory = options.memory,
                                                  .tables = std::move(tables),
                                                  .max_cost_growth = max_cost_growth});
  const std::chrono::duration<double> build = std::chrono::steady_clock::now() - start;
  tables = prepared.tables();
  const DisplayOptions display = with_exposure(arguments, prepared, camera, size);
  options.passes = passes_of(arguments.sampling, *integrator, display, files);
  const std::string shown_name =
      (arguments.sampling.shard || files.picture == "-" ? arguments.scene : files.picture.string());
  if (files.display_server != nullptr) show_passes(options, *files.display_server, shown_name);
  auto [film, failure] = render_and_save(prepared, camera, size, options, arguments, files);
  if (files.display_server != nullptr) files.display_server->show(shown_name, film);
  times.build += build.count();
  apply_display(film, display);
  if (!arguments.quiet) warn_about(counts, options.threads);
  const Scene& drawn = prepared.scene();
  if (!std::holds_alternative<Aov>(*arguments.integrator) && (arguments.strict || !arguments.quiet))
    warnings.report_picture(
        picture_warning(view_of(film, prepared, camera, options), arguments, drawn), "content");
  watch.rendered(times);  // with the rays of the warning
  if (!arguments.sampling.shard) {
    const auto instants = options.shutter ? std::optional(options.shutter->times) : std::nullopt;
    save_picture(arguments, drawn, camera, instants, film, files);
  }
  watch.written();
  if (reports_files(arguments)) {
    report_written({.main = arguments.sampling.shard ? files.samples->checkpoint() : files.picture,
                    .sidecar = files.sidecar},
                   film.size(), counts.samples_per_pixel, film.display, watch.seconds());
  }
  watch.report(arguments.statistics, drawn, film.size(), counts, options.threads, *options.memory);
  if (failure) std::rethrow_exception(failure);
}

}  // namespace microtrace::cli
