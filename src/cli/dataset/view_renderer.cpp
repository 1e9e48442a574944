#include "cli/dataset/view_renderer.hpp"

#include "base/system/processors.hpp"
#include "base/text/named_items.hpp"
#include "base/text/printable.hpp"
#include "cli/camera.hpp"
#include "cli/dataset/plan.hpp"
#include "cli/options/values.hpp"
#include "cli/pictures/environment.hpp"
#include "cli/pictures/sequence.hpp"
#include "cli/report/unusual_counts.hpp"

#include <microtrace/digest.hpp>
#include <microtrace/render.hpp>

#include <algorithm>
#include <span>
#include <string>
#include <string_view>
#include <unistd.h>
#include <utility>

namespace microtrace::cli {
namespace {

namespace fs = std::filesystem;

void create_folder_of(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path.parent_path(), error);  // writing the file reports failures
}

/// Moves a camera from world space to the scene's coordinates.
Camera in_scene(const Scene& scene, Camera camera) {
  std::visit([&](auto& c) { c.pose.position -= scene.origin; }, camera);
  return camera;
}

/// Returns the values of a channel; empty if the film lacks it.
template <class Number>
std::span<const Number> values_of(const Film& film, std::string_view name) {
  const auto found = std::ranges::find(film.channels, name, &Channel::name);
  if (found == film.channels.end()) return {};
  return std::get<std::vector<Number>>(found->values);
}

/// True if the view has the camera that the options describe.
bool has_camera_of_options(const DatasetView& view) {
  const auto* name = std::get_if<std::string>(&view.camera);
  return name != nullptr && name->empty();
}

std::string place_of(std::uint32_t index) {
  return "--views: view " + std::to_string(index);
}

}  // namespace

ViewRenderer::ViewRenderer(Arguments& arguments, Warnings& warnings)
    : arguments_(arguments),
      warnings_(warnings),
      memory_(arguments.memory_limit.value_or(default_memory_limit())),
      variant_(arguments.load.variant) {
  arguments_.load.memory = &memory_;
  arguments_.load.detail = surface_detail(arguments_);
  file_.emplace(arguments_.scene, arguments_.load);
  apply_defaults(arguments_, file_->format());
  integrator_ = make_integrator(*arguments_.integrator);
  if (arguments_.denoises) denoiser_.emplace();
}

void ViewRenderer::load_environment(const DatasetView& view, std::vector<Diagnostic>& warnings) {
  const std::string source = view.environment.value_or("");
  if (environment_ && environment_source_ == source) return;
  EnvironmentOptions options = arguments_.environment;
  if (view.environment) options.source = parse_environment({.option = "--env", .text = source});
  environment_ = cli::load_environment(options, warnings, memory_);
  environment_source_ = source;
}

void ViewRenderer::load(const DatasetView& view) {
  if (loaded_ && share_scene(*loaded_, view)) return;
  loaded_.reset();  // in case that something below throws
  prepared_.reset();
  scene_.reset();
  LoadOptions load = arguments_.load;
  load.variant = view.variant.value_or(arguments_.load.variant);
  if (load.variant != variant_ || !file_) {
    file_.reset();
    file_.emplace(arguments_.scene, load);
    variant_ = load.variant;
  }
  LoadedScene loaded = file_->at(view.time ? view.time : arguments_.load.time);
  load_environment(view, loaded.warnings);
  warnings_.report(loaded.warnings);
  EnvironmentOptions options = arguments_.environment;
  if (view.environment_rotation) options.rotation = view.environment_rotation;
  if (view.environment_intensity)
    options.intensity = static_cast<float>(*view.environment_intensity);
  apply_environment(loaded.scene, environment_, options);
  scene_ = std::make_shared<const Scene>(std::move(loaded.scene));
  if (const auto warning = ground_warning(arguments_, *scene_)) warnings_.report({*warning});
  check_objects();
  loaded_ = view;
}

void ViewRenderer::check_objects() {
  if (!writes(arguments_, DatasetFormat::bop)) return;
  Digest digest;
  const auto add = [&](const auto& number) {
    digest.add({reinterpret_cast<const char*>(&number), sizeof number});
  };
  add(scene_->origin);
  for (const Object& object : scene_->objects) {
    digest.add(object.name.str() + '\n');
    const auto* mesh = std::get_if<Mesh>(&object.shape);
    for (std::size_t i = 0; mesh != nullptr && i < mesh->positions.size(); ++i)
      add(mesh->position(i));
  }
  if (!objects_) objects_ = digest.value();
  if (objects_ != digest.value())
    throw Error(ErrorKind::usage, arguments_.scene,
                "shows different objects, or objects that move, at different times or in variants, "
                "but BOP has one list of models in one pose; write them into data sets of their "
                "own");
}

void ViewRenderer::check_camera(const DatasetView& view, std::uint32_t index) const {
  std::optional<Camera> camera;
  if (const auto* own = std::get_if<Camera>(&view.camera))
    camera = *own;
  else if (std::holds_alternative<std::string>(view.camera))
    camera = choose_camera(*scene_, camera_options(view, index), {.width = 1, .height = 1});
  else  // frames the scene, so it is perspective
    (void)with_lens(PerspectiveCamera{}, camera_options(view, index));
  if (camera && writes(arguments_, DatasetFormat::bop))
    require_bop_camera(*camera, place_of(index));
}

void ViewRenderer::check_look(const DatasetView& view, std::uint32_t index) const {
  const std::string place = place_of(index);
  if (view.variant && !view.variant->empty()) {
    const std::vector<std::string> names = file_->choices().variants;
    if (!find_item(*view.variant, names))
      throw Error(ErrorKind::usage, place, no_such_item("variant", *view.variant, names));
  }
  if (!view.environment) return;
  const EnvironmentSource source =
      parse_environment({.option = place + ": the environment", .text = *view.environment});
  // Not opened, because that would end a pipe.
  const auto* path = std::get_if<fs::path>(&source);
  if (path != nullptr && ::access(path->c_str(), R_OK) != 0)
    throw Error(ErrorKind::io, place, printable(path->string()) + " can't be opened");
}

CameraOptions ViewRenderer::camera_options(const DatasetView& view, std::uint32_t index) const {
  if (has_camera_of_options(view)) return arguments_.camera;
  const auto* name = std::get_if<std::string>(&view.camera);
  CameraOptions options;
  if (const auto* direction = std::get_if<View>(&view.camera)) {
    options.orbit = OrbitView{.view = *direction};
    options.lens_radius = arguments_.camera.lens_radius;
    options.focus = arguments_.camera.focus;
  } else if (name != nullptr) {
    options.camera = *name;
    options.place = place_of(index);
  }
  return options;
}

Camera ViewRenderer::camera_of(const DatasetView& view, std::uint32_t index, ImageSize size) {
  if (const auto* camera = std::get_if<Camera>(&view.camera)) return in_scene(*scene_, *camera);
  if (arguments_.frames && !view.size && has_camera_of_options(view)) {
    // Only when needed, because all frames are posed.
    if (!framing_) framing_ = frame_all(*file_, Sequence(arguments_), arguments_);
    if (*framing_) return in_coordinates_of(*scene_, **framing_);
  }
  return choose_camera(*scene_, camera_options(view, index), size);
}

std::string ViewRenderer::save_picture(Film& film, const std::string& name,
                                       const fs::path& folder) const {
  const fs::path path = folder / name;
  create_folder_of(path);
  // PNG stores only colors.
  std::vector<Channel> hidden;
  const bool hides = path.extension() == ".png";
  if (hides) hidden.swap(film.channels);
  save_image(film, path);
  if (hides) hidden.swap(film.channels);
  return name;
}

void ViewRenderer::save_annotations(const DatasetView& view, const AnnotatedPicture& picture,
                                    Film& film, const fs::path& folder,
                                    std::vector<std::string>& names) {
  const bool is_coco = writes(arguments_, DatasetFormat::coco),
             is_bop = writes(arguments_, DatasetFormat::bop);
  AnnotationFormats formats;
  if (is_coco) formats.coco = arguments_.dataset.coco;
  if (is_bop) formats.bop_depth_scale = arguments_.dataset.depth_scale;
  const Annotations annotations = annotate(*prepared_, picture, formats, arguments_.threads);
  warnings_.report_picture(annotations.bop.too_far, "far depths");
  warnings_.report_picture(annotations.bop.too_near, "near depths");
  const auto save = [&](const std::string& name, const std::string& bytes) {
    write_dataset_file(folder / name, bytes);
    names.push_back(name);
  };
  const auto save_part = [&](DatasetFormat format, const std::string& part) {
    save(annotations_name(arguments_, view, picture.index, format), part);
  };
  if (is_coco) save_part(DatasetFormat::coco, annotations.coco);
  if (!is_bop) return;
  for (const NamedFile& file : annotations.bop.files) save(kBopScene + file.name, file.bytes);
  save_part(DatasetFormat::bop, annotations.bop.part);
  names.push_back(save_picture(film, bop_picture_name(picture.index), folder));
}

void ViewRenderer::prepare(const DatasetView& view) {
  load(view);
  if (prepared_) return;
  prepared_.emplace(scene_, PrepareOptions{.threads = arguments_.threads,
                                           .memory = &memory_,
                                           .tables = std::exchange(tables_, nullptr)});
  tables_ = prepared_->tables();
}

Film ViewRenderer::draw(const Camera& camera, ImageSize size, const std::vector<Aov>& aovs) {
  RenderCounts counts;
  const unsigned threads = thread_count(arguments_.threads);
  const RenderOptions options{.threads = threads,
                              .integrator = integrator_.get(),
                              .samples = arguments_.sampling.samples,
                              .filter = arguments_.sampling.filter,
                              .seed = arguments_.sampling.seed,
                              .counts = &counts,
                              .memory = &memory_,
                              .aovs = aovs,
                              .sampled_aovs = arguments_.aovs.sampled,
                              .transparent = arguments_.environment.is_transparent()};
  Film film = denoiser_ ? denoiser_->render(*prepared_, camera, size, options)
                        : microtrace::render(*prepared_, camera, size, options);
  apply_display(film, arguments_.display);
  if (!arguments_.quiet && !has_warned_) has_warned_ = warn_about(counts, threads);
  return film;
}

std::vector<Aov> ViewRenderer::annotation_channels() const {
  const bool is_bop = writes(arguments_, DatasetFormat::bop);
  std::vector<Aov> aovs;
  if (is_bop || writes(arguments_, DatasetFormat::coco)) aovs.push_back(Aov::id);
  if (is_bop) aovs.push_back(Aov::depth);
  return aovs;
}

std::vector<std::string> ViewRenderer::render(const DatasetView& view, std::uint32_t index,
                                              const fs::path& folder) {
  prepare(view);
  const ImageSize size = size_of(arguments_, view, *scene_);
  const Camera camera = camera_of(view, index, size);
  const std::vector<Aov>& shown = arguments_.aovs.exact;
  std::vector<Aov> hidden = annotation_channels();
  const bool is_annotated = !hidden.empty();
  std::erase_if(hidden, [&](Aov aov) { return std::ranges::find(shown, aov) != shown.end(); });
  std::vector<Aov> all = shown;
  all.insert(all.end(), hidden.begin(), hidden.end());
  Film film = draw(camera, size, all);
  std::vector<std::string> names;
  if (is_annotated) {
    const AnnotatedPicture picture{.index = index,
                                   .file = picture_name(arguments_, view, index),
                                   .camera = camera,
                                   .size = size,
                                   .ids = values_of<std::uint32_t>(film, "id.instance"),
                                   .depth = values_of<float>(film, "depth.Z")};
    save_annotations(view, picture, film, folder, names);
  }
  for (const Aov aov : hidden) {
    std::erase_if(film.channels, [&](const Channel& c) {
      return c.name.starts_with(std::string(name_of(aov)) + ".");
    });
  }
  save_pictures(stem_of(arguments_, view, index), film, folder, names);
  return names;
}

void ViewRenderer::save_pictures(const std::string& stem, Film& film, const fs::path& folder,
                                 std::vector<std::string>& names) const {
  if (writes(arguments_, DatasetFormat::png))
    names.push_back(save_picture(film, stem + ".png", folder));
  if (writes(arguments_, DatasetFormat::exr))
    names.push_back(save_picture(film, stem + ".exr", folder));
  if (writes(arguments_, DatasetFormat::npz)) {
    names.push_back(stem + ".npz");
    write_dataset_file(folder / names.back(), npz_of(film));
  }
}

}  // namespace microtrace::cli
