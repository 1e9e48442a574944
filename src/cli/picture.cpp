#include "cli/picture.hpp"

#include "cli/progress_bar.hpp"
#include "cli/verbose.hpp"

#include <microtrace/render.hpp>
#include <microtrace/segments.hpp>
#include <microtrace/sidecar.hpp>
#include <microtrace/threads.hpp>

#include <algorithm>

namespace microtrace::cli {
std::function<void(double)> progress_of(const Arguments& arguments, std::uint32_t pictures) {
  if (arguments.progress == Progress::json) return progress_lines();
  return arguments.quiet || arguments.progress == Progress::none ? nullptr : progress_bar(pictures);
}

void check_outputs(const Arguments& arguments, const std::filesystem::path& output,
                   const std::filesystem::path& sidecar) {
  check_image_path(output, {.alpha = arguments.surroundings.is_transparent(),
                            .channels = !arguments.aovs.empty()});
  if (!sidecar.empty()) check_sidecar_path(sidecar, output);
}

void make_picture(Scene scene, const Camera& camera, ImageSize size, const Arguments& arguments,
                  const std::filesystem::path& output, const std::filesystem::path& sidecar,
                  Stopwatch& watch, const std::function<void(double)>& progress) {
  if (arguments.verbose) tell_of_scene(arguments, scene, size);
  widen_segments(scene, camera, size);  // for the sidecar too, that its ids are the picture's
  const std::unique_ptr<Integrator> integrator = make_integrator(arguments);
  RenderTimes times;
  RenderOptions options{
      .threads = arguments.threads != 0 ? arguments.threads : default_threads(),
      .progress = progress,
      .times = &times,
      .integrator = integrator.get(),
      .samples = arguments.sampling.samples,
      .filter = arguments.sampling.filter,
      .seed = arguments.sampling.seed,
      .crop = arguments.crop,
      .aovs = arguments.aovs,
      .transparent = arguments.surroundings.is_transparent(),
  };
  // The sidecar counts pixels by their ids, whether the picture keeps these or not.
  const bool ids_for_sidecar_alone =
      !sidecar.empty() && std::ranges::find(options.aovs, Aov::id) == options.aovs.end();
  if (ids_for_sidecar_alone) options.aovs.push_back(Aov::id);
  Film film = render(scene, camera, size, options);
  watch.rendered(times);
  expose(film, arguments.exposure);

  Sidecar beside{.path = sidecar, .text = {}};
  if (!sidecar.empty())
    beside.text = describe_picture(scene, camera, film, output.filename().string());
  if (ids_for_sidecar_alone)
    std::erase_if(film.channels, [](const Channel& c) { return c.name.starts_with("id."); });
  save_image(film, output, arguments.ppm, sidecar.empty() ? nullptr : &beside);
  watch.written();
  if (arguments.verbose) {
    tell_of_file(output);
    if (!sidecar.empty()) tell_of_file(sidecar);
  }
  watch.report(arguments.statistics, scene, film.size(), arguments.sampling.samples,
               options.threads);
}

}  // namespace microtrace::cli
