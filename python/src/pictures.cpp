/// Renders into NumPy arrays, and saves pictures.

#include "base/system/float_environment.hpp"
#include "common.hpp"
#include "io/image/encode/eight_bits.hpp"
#include "prepared.hpp"
#include "scene_reader.hpp"
#include "scene_writer.hpp"

#include <microtrace/denoise.hpp>
#include <microtrace/exposure.hpp>

#include <algorithm>
#include <array>
#include <memory>
#include <mutex>
#include <nanobind/stl/array.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <optional>
#include <string>
#include <vector>

namespace microtrace::python {
namespace {

/// A writable, C-contiguous array of shape (height, width, channels).
template <class T>
using Pixels = nb::ndarray<T, nb::ndim<3>, nb::c_contig, nb::device::cpu>;

/// An array's name in Python, its AOV, and the channels that it contains.
struct Quantity {
  const char* name;
  const char* aov;
  const char* channels;  ///< one letter per channel, or the name of a single channel
  std::size_t id_channel = 0;

  [[nodiscard]] bool is_id() const { return std::string_view(aov) == "id"; }
  /// Returns the names of the channels as in Channel::name.
  [[nodiscard]] std::vector<std::string> channel_names() const {
    const std::string before = std::string(aov) + ".";
    if (is_id()) return {before + channels};
    std::vector<std::string> result;
    for (const char* letter = channels; *letter != 0; ++letter) result.push_back(before + *letter);
    return result;
  }
};
constexpr std::array kQuantities = {
    Quantity{"depth", "depth", "Z"},
    Quantity{"distance", "distance", "T"},
    Quantity{"position", "position", "XYZ"},
    Quantity{"normal", "normal", "XYZ"},
    Quantity{"face_normal", "face_normal", "XYZ"},
    Quantity{"uv", "uv", "UV"},
    Quantity{"barycentric", "barycentric", "XYZ"},
    Quantity{"albedo", "albedo", "RGB"},
    Quantity{"object", "id", "instance"},
    Quantity{"primitive", "id", "primitive", 1},
    Quantity{"material", "id", "material", 2},
    Quantity{"variance", "variance", "Y"},
    Quantity{"samples", "samples", "N"},
    Quantity{"denoise_albedo", "denoise_albedo", "RGB"},
    Quantity{"denoise_normal", "denoise_normal", "XYZ"},
    Quantity{"emission", "emission", "RGB"},
    Quantity{"noisy", "noisy", "RGB"},
    Quantity{"denoise_emission", "denoise_emission", "RGB"},
};

/// A channel of the film, and the destination of its values.
struct Target {
  std::string channel;  ///< Channel::name
  void* first;          ///< destination of the first pixel's value
  std::size_t step;     ///< distance between the values of neighboring pixels, in values
};

void copy_channel(const Film& film, const Target& target) {
  const auto channel = std::ranges::find(film.channels, target.channel, &Channel::name);
  std::visit(
      [&]<class T>(const std::vector<T>& values) {
        T* to = static_cast<T*>(target.first);
        for (const T& value : values) *to = value, to += target.step;
      },
      channel->values);
}

/// The arrays to fill, except for the color.
struct Outputs {
  explicit Outputs(const nb::dict& outputs) {
    for (const Quantity& quantity : kQuantities) {
      if (!outputs.contains(quantity.name)) continue;
      const auto pixels = nb::cast<nb::ndarray<nb::c_contig>>(outputs[quantity.name]);
      const std::vector<std::string> names = quantity.channel_names();
      for (std::size_t k = 0; k < names.size(); ++k)
        targets.push_back({.channel = names[k],
                           .first = static_cast<float*>(pixels.data()) + k,  // 4 bytes each
                           .step = names.size()});
      if (const auto aov = aov_named(quantity.aov)) {
        if (std::ranges::find(exact, *aov) == exact.end()) exact.push_back(*aov);
        AovBuffer buffer{.aov = *aov,
                         .row_stride = pixels.stride(0),
                         .pixel_stride = static_cast<std::ptrdiff_t>(names.size())};
        if (*aov == Aov::id) {
          buffer.data = static_cast<std::uint32_t*>(pixels.data());
          buffer.channel = quantity.id_channel;
        } else {
          buffer.data = static_cast<float*>(pixels.data());
        }
        buffers.push_back(buffer);
      } else {
        sampled.push_back(sampled_aov_named(quantity.aov).value());
      }
    }
  }

  std::vector<Target> targets;
  std::vector<Aov> exact;
  std::vector<SampledAov> sampled;
  std::vector<AovBuffer> buffers;  ///< destinations of the exact AOVs
};

void copy_colors(const Film& film, const Pixels<float>& to) {
  const std::size_t channels = to.shape(2);
  float* out = to.data();
  for (std::uint32_t y = 0; y < film.size().height; ++y) {
    const auto colors = film.row(y);
    for (std::size_t x = 0; x < colors.size(); ++x, out += channels) {
      out[0] = colors[x].x, out[1] = colors[x].y, out[2] = colors[x].z;
      if (channels == 4) out[3] = film.alpha_row(y)[x];
    }
  }
}

BsdfModel model_named(const std::string& name) {
  if (name == "conserving") return BsdfModel::conserving;
  if (name == "spec") return BsdfModel::spec;
  throw nb::value_error("bsdf must be \"conserving\" or \"spec\"");
}

IntegratorOptions integrator_of(const std::string& name, const nb::dict& arguments) {
  if (name == "flat") return FlatOptions{};
  if (name != "path") throw nb::value_error("integrator must be \"path\" or \"flat\"");
  PathOptions options;
  options.max_depth = nb::cast<std::uint32_t>(arguments["max_depth"]);
  options.bsdf = model_named(nb::cast<std::string>(arguments["bsdf"]));
  options.guiding = nb::cast<bool>(arguments["guiding"]);
  if (const nb::object ground = arguments["ground"]; !ground.is_none())
    options.ground = Ground{.height = nb::cast<std::optional<double>>(ground["height"])};
  return options;
}

PixelFilter filter_named(const std::string& name) {
  if (name == "box") return PixelFilter::box;
  if (name == "blackman-harris") return PixelFilter::blackman_harris;
  throw nb::value_error("filter must be \"box\" or \"blackman-harris\"");
}

/// Calls a Python function with the finished fraction. It cancels the rendering by returning False.
class Progress {
 public:
  /// The arguments must outlive this object. Threads without Python's lock must not copy
  /// `function`, because counting references needs the lock.
  Progress(const nb::object& function, Caller& caller) : function_(function), caller_(caller) {}

  bool operator()(double share) {
    if (caller_.is_canceled()) return false;
    if (!function_.is_valid() || function_.is_none()) return true;
    bool continues = false;
    return caller_.call(function_, share, [&](PyObject* result) {
      continues = result != nullptr && result != Py_False;
      if (result == nullptr) failure_ = std::make_exception_ptr(nb::python_error());
    }) && continues;
  }

  /// Rethrows the exception that the function threw, if any.
  void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  const nb::object& function_;
  Caller& caller_;
  std::exception_ptr failure_;
};

/// Calls a Python function that returns the scene and the camera at a time.
class Moments {
 public:
  explicit Moments(nb::object function) : function_(std::move(function)) {}

  Caller* caller = nullptr;  ///< set while a picture is rendered

  Moment operator()(double time) {
    std::optional<Moment> moment;
    const auto use = [&](PyObject* result) {
      try {
        if (result == nullptr) throw nb::python_error();
        latest_ = nb::cast<nb::tuple>(nb::borrow(result));
        moment = Moment{.scene = nb::cast<const Prepared&>(latest_[0]).scene,
                        .camera = camera_from_python(latest_[1])};
      } catch (...) {
        failure_ = std::current_exception();
      }
    };
    if (caller->call(function_, time, use) && moment) return *std::move(moment);
    throw Error(ErrorKind::canceled, "", "the shutter's function failed");
  }

  /// Rethrows the exception that the function threw, if any.
  void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  nb::object function_;
  nb::tuple latest_;  // outlives the renderer's copy, which is destroyed without Python's lock
  std::exception_ptr failure_;
};

ImageSize size_of(const nb::dict& arguments) {
  const auto [width, height] = nb::cast<std::array<std::uint32_t, 2>>(arguments["size"]);
  return {.width = width, .height = height};
}

struct PictureOptions {
  std::unique_ptr<Integrator> integrator{};
  RenderOptions options{};
};

/// Returns what is rendered and how, but not which part of the picture.
PictureOptions options_of(const Prepared& self, const nb::dict& arguments) {
  const FloatEnvironment rounding;  // of the colors
  const IntegratorOptions integrator_options =
      integrator_of(nb::cast<std::string>(arguments["integrator"]), arguments);
  const nb::object samples = arguments["spp"], background = arguments["background"];
  PictureOptions result{.integrator = make_integrator(integrator_options)};
  result.options = {
      .threads = nb::cast<unsigned>(arguments["threads"]),
      .integrator = result.integrator.get(),
      .samples = samples.is_none() ? default_samples(integrator_options)
                                   : nb::cast<std::uint32_t>(samples),
      .filter = filter_named(nb::cast<std::string>(arguments["filter"])),
      .seed = nb::cast<std::uint32_t>(arguments["seed"]),
      .environment = environment_from_python(arguments["environment"]),
  };
  const std::optional<Environment>& of_scene = self.scene.scene().environment;
  if (of_scene && !result.options.environment && nb::cast<bool>(arguments["hides_environment"])) {
    result.options.environment = of_scene;
    result.options.environment->is_background = false;
  }
  if (!background.is_none()) {
    const auto c = nb::cast<std::array<double, 3>>(background);
    result.options.background = Vec3(DVec3(c[0], c[1], c[2]));
  } else if (!self.has_background) {
    result.options.background = default_background(SceneFormat::gltf, integrator_options);
  }
  return result;
}

/// Returns the exposure, in stops, at which surfaces are neither blown out nor black.
double exposure_for(const Prepared& self, const nb::object& camera, const nb::dict& arguments) {
  PictureOptions picture = options_of(self, arguments);
  const Camera from = camera_from_python(camera);
  const ImageSize size = size_of(arguments);
  double exposure = 0;
  run_interruptible([&](const Caller& caller) {
    picture.options.progress = [&](double) { return !caller.is_canceled(); };
    exposure = automatic_exposure(self.scene, from, size, picture.options);
  });
  return exposure;
}

/// Fills the arrays in `outputs`. outputs["color"], if present, is (height, width, 3 or 4) float32.
/// Returns the tone map for displaying the colors.
std::string render_into(const Prepared& self, const nb::object& camera_object,
                        const nb::dict& outputs, const nb::dict& arguments) {
  const Camera camera = camera_from_python(camera_object);
  const ImageSize size = size_of(arguments);
  const bool has_color = outputs.contains("color");
  const PictureOptions picture = options_of(self, arguments);
  RenderOptions options = picture.options;
  options.transparent = has_color && nb::cast<Pixels<float>>(outputs["color"]).shape(2) == 4;
  if (const nb::object crop = arguments["crop"]; !crop.is_none()) {
    const auto c = nb::cast<std::array<std::uint32_t, 4>>(crop);
    options.crop = PixelRect{.x0 = c[0], .y0 = c[1], .x1 = c[2], .y1 = c[3]};
  }
  std::optional<Moments> moments;
  if (const nb::object shutter = arguments["shutter"]; !shutter.is_none()) {
    moments.emplace(shutter[0]);
    options.shutter = Shutter{.times = {.open = nb::cast<double>(shutter[1]),
                                        .close = nb::cast<double>(shutter[2]),
                                        .count = nb::cast<std::uint32_t>(shutter[3])},
                              .moment = std::ref(*moments)};
  }
  const Outputs arrays(outputs);
  const bool has_samples = has_color || !arrays.sampled.empty();
  if (has_samples) {
    options.aovs = arrays.exact;
    options.sampled_aovs = arrays.sampled;
  }
  std::optional<Film> film;
  const nb::object function = arguments["progress"];
  run_interruptible([&](Caller& caller) {
    Progress progress(function, caller);
    if (moments) moments->caller = &caller;
    options.progress = std::ref(progress);
    try {
      if (has_samples)
        film = render(self.scene, camera, size, options);
      else
        render_aovs(self.scene, camera, size, arrays.buffers, options);
    } catch (const Error&) {
      if (moments) moments->rethrow();
      progress.rethrow();
      throw;
    }
  });
  if (!film) return "none";
  std::optional<Pixels<float>> color;
  if (has_color) color = nb::cast<Pixels<float>>(outputs["color"]);
  run_unlocked([&] {
    for (const Target& target : arrays.targets) copy_channel(*film, target);
    if (color) copy_colors(*film, *color);
  });
  return std::string(name_of(film->display.tone_map));
}

/// Makes a film from `color`, (height, width, 3 or 4), and the other arrays. Its colors are to be
/// displayed with this exposure and tone map.
Film film_of(const Pixels<const float>& color, double exposure, const std::string& tone_map,
             const nb::dict& channels) {
  const auto map = tone_map_named(tone_map);
  if (!map) {
    std::string names;
    for (const ToneMap each : kToneMaps)
      names.append(names.empty() ? "" : ", ").append(name_of(each));
    throw nb::value_error(("tone_map must be one of " + names).c_str());
  }
  const std::size_t count = color.shape(2);
  Film film({.width = static_cast<std::uint32_t>(color.shape(1)),
             .height = static_cast<std::uint32_t>(color.shape(0))},
            count == 4 ? Film::Alpha::premultiplied : Film::Alpha::none);
  run_unlocked([&] {
    const float* from = color.data();
    for (std::uint32_t y = 0; y < film.size().height; ++y) {
      for (std::uint32_t x = 0; x < film.size().width; ++x, from += count) {
        film.at(x, y) = {from[0], from[1], from[2]};
        if (count == 4) film.alpha_at(x, y) = from[3];
      }
    }
  });
  film.display.exposure = exposure;
  film.display.tone_map = *map;
  const std::size_t pixel_count = color.shape(0) * color.shape(1);
  for (const Quantity& quantity : kQuantities) {
    if (!channels.contains(quantity.name)) continue;
    const auto pixels = nb::cast<nb::ndarray<nb::ro, nb::c_contig>>(channels[quantity.name]);
    const std::vector<std::string> names = quantity.channel_names();
    const auto add = [&]<class T>(const T* first) {
      for (std::size_t k = 0; k < names.size(); ++k) {
        std::vector<T> values(pixel_count);
        for (std::size_t i = 0; i < pixel_count; ++i) values[i] = first[i * names.size() + k];
        film.channels.push_back({.name = names[k], .values = std::move(values)});
      }
    };
    run_unlocked([&] {
      if (quantity.is_id())
        add(static_cast<const std::uint32_t*>(pixels.data()));
      else
        add(static_cast<const float*>(pixels.data()));
    });
  }
  return film;
}

void save(const Pixels<const float>& color, double exposure, const std::string& tone_map,
          const std::string& denoiser, const nb::dict& channels,
          const std::array<std::uint32_t, 4>& part, const std::filesystem::path& path) {
  Film film = film_of(color, exposure, tone_map, channels);
  film.denoiser = denoiser;
  film.whole = {.width = part[0], .height = part[1]};
  film.x0 = part[2];
  film.y0 = part[3];
  run_unlocked([&] { save_image(film, path); });
}

void encode(const Pixels<const float>& color, double exposure, const std::string& tone_map,
            const Pixels<std::uint8_t>& to) {
  const Film film = film_of(color, exposure, tone_map, nb::dict());
  run_unlocked([&] {
    const FloatEnvironment environment;
    for (std::uint32_t y = 0; y < film.size().height; ++y)
      io::encode_row(film, y, to.data() + std::size_t{y} * to.shape(1) * to.shape(2));
  });
}

std::string denoiser_name() {
  return Denoiser().name();
}

/// Replaces the colors by denoised ones. `features` are the arrays of kDenoiseFeatures.
void denoise(const Pixels<float>& color, const nb::dict& features, bool has_lens, bool has_ground,
             unsigned threads) {
  Film film = film_of(Pixels<const float>(color), 0, "none", features);
  film.has_lens = has_lens;
  film.has_ground = has_ground;
  run_interruptible([&](const Caller& caller) {
    Denoiser().denoise(
        film, {.threads = threads, .progress = [&](double) { return !caller.is_canceled(); }});
  });
  run_unlocked([&] { copy_colors(film, color); });
}

nb::object frame_scene(const Prepared& self, double azimuth, double elevation, double fov,
                       std::array<std::uint32_t, 2> size) {
  const View view{.azimuth = azimuth, .elevation = elevation, .vertical_fov = fov};
  return camera_to_python(frame(self.scene.scene(), view, {.width = size[0], .height = size[1]}),
                          "");
}

}  // namespace

void bind_pictures(nb::module_& module) {
  nb::list names;
  for (const Quantity& quantity : kQuantities) {
    names.append(nb::make_tuple(quantity.name, quantity.channel_names().size(), quantity.is_id()));
  }
  module.attr("quantities") = nb::tuple(names);
  module.def("render", &render_into, nb::arg("scene"), nb::arg("camera").none(), nb::arg("outputs"),
             nb::arg("arguments"), WholeCall());
  module.def("automatic_exposure", &exposure_for, nb::arg("scene"), nb::arg("camera").none(),
             nb::arg("arguments"), WholeCall());
  module.def("save", &save, WholeCall());
  module.def("denoiser_name", &denoiser_name, WholeCall());
  module.def("denoise", &denoise, WholeCall());
  module.def("encode", &encode, WholeCall());
  module.def("frame", &frame_scene, WholeCall());
}

}  // namespace microtrace::python
