#include "cli/view/picture_job.hpp"

#include "base/system/processors.hpp"
#include "cli/camera.hpp"
#include "cli/options/applicable.hpp"
#include "cli/options/parse.hpp"
#include "cli/pictures/environment.hpp"
#include "cli/pictures/exposure.hpp"
#include "cli/report/warnings.hpp"

#include <microtrace/defaults.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <utility>
#include <variant>
#include <vector>

namespace microtrace::cli {

Arguments parse_picture(const Arguments& program, const std::string& lines) {
  std::vector<std::string> words{program.scene};
  std::istringstream stream(lines);
  for (std::string word; std::getline(stream, word);) words.push_back(word);
  Arguments arguments = parse_words(Command::view, std::move(words));
  arguments.scene = program.scene;
  arguments.threads = program.threads;
  return arguments;
}

PictureJob make_job(SceneSource& source, Arguments arguments) {
  std::shared_ptr<const ShownScene> shown_scene = source.get(arguments.load);
  PictureJob job{.scene = std::move(shown_scene),
                 .arguments = std::move(arguments),
                 .omitted = {},
                 .warning = {},
                 .size = {},
                 .camera = {},
                 .integrator = nullptr,
                 .options = {},
                 .denoiser = {},
                 .display = {}};
  Arguments& a = job.arguments;
  choose_integrator(a, job.scene->format);
  job.omitted = omit_inapplicable(a);
  apply_defaults(a, job.scene->format);
  const Scene& scene = job.scene->prepared.scene();
  job.warning = ground_warning(a, scene);
  job.size = a.size.value_or(scene.size);
  job.camera = choose_camera(scene, a.camera, job.size);
  job.integrator = make_integrator(*a.integrator);
  // Only these members depend on options, so the prepared scene serves all environments.
  Scene light;
  light.environment = scene.environment;
  light.background = scene.background;
  apply_environment(light, source.environment(a.environment), a.environment);
  job.options = {.threads = thread_count(a.threads),
                 .integrator = job.integrator.get(),
                 .samples = a.sampling.samples,
                 .filter = a.sampling.filter,
                 .seed = a.sampling.seed,
                 .memory = &source.memory(),
                 .environment = light.environment,
                 .background = light.background,
                 .crop = a.crop,
                 .aovs = a.aovs.exact,
                 .sampled_aovs = a.aovs.sampled,
                 .transparent = a.environment.is_transparent()};
  if (a.sampling.needs_passes()) {
    job.options.passes =
        Passes{.target_error = a.sampling.target_error, .time_limit = a.sampling.time_limit};
  }
  a.display = with_exposure(a.display, job.scene->prepared, job.camera, job.size, job.options);
  if (a.denoises) job.denoiser.emplace();
  Film shown({.width = 1, .height = 1});
  shown.display = job.integrator->display(shown);
  apply_display(shown, a.display);
  job.display = shown.display;
  return job;
}

Film render(const PictureJob& job) {
  const PreparedScene& scene = job.scene->prepared;
  Film film = job.denoiser ? job.denoiser->render(scene, job.camera, job.size, job.options)
                           : microtrace::render(scene, job.camera, job.size, job.options);
  apply_display(film, job.arguments.display);
  return film;
}

bool shows_variance(const PictureJob& job) {
  return job.options.aovs.empty() && job.options.sampled_aovs == std::vector{SampledAov::variance};
}

Film deviation_picture(const Film& film) {
  const auto& variances = std::get<std::vector<float>>(film.channels.front().values);
  std::vector<float> deviations(variances.size());
  std::ranges::transform(variances, deviations.begin(), [](float v) { return std::sqrt(v); });
  Film picture(film.size());
  for (std::uint32_t y = 0, i = 0; y < film.size().height; ++y) {
    for (std::uint32_t x = 0; x < film.size().width; ++x) picture.at(x, y) = Vec3(deviations[i++]);
  }
  // A few pixels with rare bright samples would make all others black.
  const auto most = deviations.begin() + static_cast<std::ptrdiff_t>(deviations.size() * 49 / 50);
  std::ranges::nth_element(deviations, most);
  picture.display = {.srgb = false, .scale = Vec3(*most > 0 ? 1 / *most : 1)};
  return picture;
}

}  // namespace microtrace::cli
