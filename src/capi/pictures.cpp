#include "base/text/split_at_commas.hpp"
#include "capi/handles.hpp"
#include "scene/validate/validate.hpp"

#include <microtrace/aov.hpp>
#include <microtrace/defaults.hpp>
#include <microtrace/denoise.hpp>
#include <microtrace/framing.hpp>
#include <microtrace/path.hpp>
#include <microtrace/render.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace microtrace::capi {
namespace {

[[noreturn]] void refuse(const std::string& reason) {
  throw Error(ErrorKind::usage, "", reason);
}

void check(const std::optional<BrokenRule>& broken, const std::string& what) {
  if (!broken) return;
  // Without a field, the message is a sentence.
  refuse(broken->field.empty() ? broken->message
                               : what + " " + broken->field + " " + broken->message);
}

IntegratorOptions integrator_of(const mt_render_options& options, SceneFormat format) {
  IntegratorOptions integrator = default_integrator(format);
  if (options.integrator == MT_FLAT) {
    integrator = FlatOptions{};
  } else if (options.integrator == MT_PATH) {
    integrator = PathOptions{};
  } else if (options.integrator != MT_DEFAULT) {
    refuse("mt_render_options::integrator is none of mt_integrator");
  }
  if (options.bsdf != MT_CONSERVING && options.bsdf != MT_SPEC)
    refuse("mt_render_options::bsdf is none of mt_bsdf");
  if (auto* path = std::get_if<PathOptions>(&integrator)) {
    if (options.max_depth != 0) path->max_depth = options.max_depth;
    if (options.bsdf == MT_SPEC) path->bsdf = BsdfModel::spec;
    path->guiding = options.guiding != 0;
  }
  return integrator;
}

/// Returns the camera in scene coordinates.
Camera camera_of(const mt_render_options& options, const Scene& scene, ImageSize size) {
  if (options.camera == nullptr) return default_camera(scene, size);
  const mt_camera& from = *options.camera;
  const auto vector = [](const double* v) { return DVec3(v[0], v[1], v[2]); };
  PerspectiveCamera camera;
  camera.pose.position = vector(from.position) - scene.origin;
  camera.pose.direction = vector(from.target) - vector(from.position);
  camera.pose.up = vector(from.up);
  if (!(from.vertical_fov > 0 && from.vertical_fov < 180)) {
    refuse("the camera's vertical_fov must lie between 0 and 180 degrees, is " +
           decimal(from.vertical_fov));
  }
  camera.vertical_fov = from.vertical_fov * (std::numbers::pi / 180);
  check(validate(Camera(camera)), "the camera's");
  return camera;
}

std::vector<Aov> aovs_of(const char* names) {
  std::vector<Aov> aovs;
  if (names == nullptr || *names == '\0') return aovs;
  for (const std::string_view name : split_at_commas(names)) {
    const auto aov = aov_named(name);
    if (!aov)
      refuse("there is no output named \"" + std::string(name) + "\" for mt_render_options::aovs");
    aovs.push_back(*aov);
  }
  return aovs;
}

/// Copies the values of a channel. Its numbers must have the type Number.
template <class Number>
mt_status copy_channel(const mt_film* film, std::size_t channel, Number* values) {
  return guarded([&] {
    require(film, "film");
    require(values, "values");
    const auto& channels = film->film.channels;
    if (channel >= channels.size())
      refuse("the film has " + std::to_string(channels.size()) + " channels beside color");
    const auto* own = std::get_if<std::vector<Number>>(&channels[channel].values);
    if (own == nullptr) refuse(channels[channel].name + " has numbers of another type");
    std::ranges::copy(*own, values);
  });
}

}  // namespace
}  // namespace microtrace::capi

using namespace microtrace;
using namespace microtrace::capi;

void mt_render_options_init(mt_render_options* options) {
  if (options == nullptr) return;
  *options = {};
  options->size = sizeof *options;
}

mt_status mt_render(const mt_scene* scene, const mt_render_options* options, mt_film** film) {
  return guarded([&] {
    require(scene, "scene");
    require(film, "film");
    const mt_render_options own = complete(options, mt_render_options_init);
    const Scene& content = scene->prepared.scene();
    ImageSize size = content.size;
    if (own.width != 0) size.width = own.width;
    if (own.height != 0) size.height = own.height;
    check(validate(size), "the picture's");
    const IntegratorOptions integrator = integrator_of(own, scene->format);
    const std::unique_ptr<Integrator> made = make_integrator(integrator);
    RenderOptions render_options{.threads = own.threads, .integrator = made.get()};
    render_options.samples = own.samples != 0 ? own.samples : default_samples(integrator);
    render_options.seed = own.seed;
    render_options.aovs = aovs_of(own.aovs);
    render_options.transparent = own.transparent != 0;
    render_options.background = default_background(scene->format, integrator);
    if (own.progress != nullptr) {
      render_options.progress = [&](double fraction) {
        return own.progress(own.user, fraction) != 0;
      };
    }
    const Camera camera = camera_of(own, content, size);
    std::optional<Denoiser> denoiser;
    if (own.denoise != 0) denoiser.emplace();
    *film = new mt_film{denoiser ? denoiser->render(scene->prepared, camera, size, render_options)
                                 : render(scene->prepared, camera, size, render_options)};
  });
}

void mt_film_release(mt_film* film) {
  delete film;
}

uint32_t mt_film_width(const mt_film* film) {
  return film != nullptr ? film->film.size().width : 0;
}

uint32_t mt_film_height(const mt_film* film) {
  return film != nullptr ? film->film.size().height : 0;
}

mt_status mt_film_rgba(const mt_film* film, float* rgba) {
  return guarded([&] {
    require(film, "film");
    require(rgba, "rgba");
    const Film& from = film->film;
    for (std::uint32_t y = 0; y < from.size().height; ++y) {
      for (std::uint32_t x = 0; x < from.size().width; ++x) {
        const Vec3& color = from.row(y)[x];
        for (int c = 0; c < 3; ++c) *rgba++ = color[c];
        *rgba++ = from.has_alpha() ? from.alpha_row(y)[x] : 1;
      }
    }
  });
}

const char* mt_film_channel_name(const mt_film* film, size_t channel) {
  if (film == nullptr) return nullptr;
  const auto& channels = film->film.channels;
  return channel < channels.size() ? channels[channel].name.c_str() : nullptr;
}

mt_status mt_film_channel_floats(const mt_film* film, size_t channel, float* values) {
  return copy_channel(film, channel, values);
}

mt_status mt_film_channel_integers(const mt_film* film, size_t channel, uint32_t* values) {
  return copy_channel(film, channel, values);
}

mt_status mt_film_save(const mt_film* film, const char* path) {
  return guarded([&] {
    require(film, "film");
    require(path, "path");
    save_image(film->film, path);
  });
}
