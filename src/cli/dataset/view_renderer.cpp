#include "cli/dataset/view_renderer.hpp"

#include "cli/dataset/plan.hpp"
#include "cli/pictures/camera.hpp"
#include "cli/pictures/environment.hpp"

#include <microtrace/render.hpp>
#include <microtrace/threads.hpp>

#include <algorithm>
#include <utility>

namespace microtrace::cli {
namespace {

namespace fs = std::filesystem;

/// The extension of the pictures.
const char* extension_of(DatasetFormat format) {
  return format == DatasetFormat::exr ? ".exr" : ".png";
}

void create_folder_of(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path.parent_path(), error);  // writing the file reports failures
}

/// Moves a camera from world space to the scene's coordinates.
Camera in_scene(const Scene& scene, Camera camera) {
  std::visit([&](auto& c) { c.pose.position -= scene.origin; }, camera);
  return camera;
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
}

void ViewRenderer::load_environment(const DatasetView& view, std::vector<Diagnostic>& warnings) {
  EnvironmentOptions options = arguments_.environment;
  if (view.environment) {
    if (environment_ && environment_source_ == *view.environment) return;
    options.source = parse_environment({.option = "--env", .text = *view.environment});
    environment_source_ = *view.environment;
  } else if (environment_ && environment_source_.empty()) {
    return;
  } else {
    environment_source_.clear();
  }
  environment_ = cli::load_environment(options, warnings, memory_);
}

void ViewRenderer::load(const DatasetView& view) {
  if (loaded_ && share_scene(*loaded_, view)) return;
  prepared_.reset();
  scene_.reset();
  LoadOptions load = arguments_.load;
  load.variant = view.variant.value_or(arguments_.load.variant);
  if (load.variant != variant_) {
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
  loaded_ = view;
}

Camera ViewRenderer::camera_of(const DatasetView& view, ImageSize size) const {
  if (const auto* camera = std::get_if<Camera>(&view.camera)) return in_scene(*scene_, *camera);
  CameraOptions options = arguments_.camera;
  if (const auto* direction = std::get_if<View>(&view.camera)) {
    options = {};
    options.orbit = OrbitView{.view = *direction};
  } else if (const std::string& name = std::get<std::string>(view.camera); !name.empty()) {
    options = {};
    options.camera = name;
  }
  return choose_camera(*scene_, options, size);
}

bool ViewRenderer::writes(DatasetFormat format) const {
  const std::vector<DatasetFormat>& formats = arguments_.dataset.formats;
  return std::ranges::find(formats, format) != formats.end();
}

std::string ViewRenderer::save_annotations(const DatasetView& view, CocoPicture picture,
                                           const Film& film, const fs::path& folder) const {
  const auto ids = std::ranges::find(film.channels, "id.instance", &Channel::name);
  const DatasetFormat format = writes(DatasetFormat::exr) && !writes(DatasetFormat::png)
                                   ? DatasetFormat::exr
                                   : DatasetFormat::png;
  picture.file = stem_of(arguments_, view, picture.index) + extension_of(format);
  picture.size = film.size();
  picture.ids = std::get<std::vector<std::uint32_t>>(ids->values);
  CocoOptions options = arguments_.dataset.coco;
  options.threads = arguments_.threads;
  std::string name = annotations_name(arguments_, view, picture.index);
  write_dataset_file(folder / name, coco_annotations(*prepared_, picture, options));
  return name;
}

std::string ViewRenderer::save(Film& film, DatasetFormat format, const std::string& stem,
                               const fs::path& folder) const {
  std::string name = stem + extension_of(format);
  const fs::path path = folder / name;
  create_folder_of(path);
  // PNG stores only colors.
  std::vector<Channel> hidden;
  if (format == DatasetFormat::png) hidden.swap(film.channels);
  save_image(film, path);
  if (format == DatasetFormat::png) hidden.swap(film.channels);
  return name;
}

std::vector<std::string> ViewRenderer::render(const DatasetView& view, std::uint32_t index,
                                              const fs::path& folder) {
  load(view);
  const unsigned threads = arguments_.threads != 0 ? arguments_.threads : default_threads();
  if (!prepared_) {
    prepared_.emplace(scene_, PrepareOptions{.threads = threads,
                                             .memory = &memory_,
                                             .tables = std::exchange(tables_, nullptr)});
    tables_ = prepared_->tables();
  }
  const ImageSize size = view.size.value_or(arguments_.size.value_or(scene_->size));
  RenderOptions options{.threads = threads,
                        .integrator = integrator_.get(),
                        .samples = arguments_.sampling.samples,
                        .filter = arguments_.sampling.filter,
                        .seed = arguments_.sampling.seed,
                        .memory = &memory_,
                        .crop = arguments_.crop,
                        .aovs = arguments_.aovs.exact,
                        .sampled_aovs = arguments_.aovs.sampled,
                        .transparent = arguments_.environment.is_transparent()};
  const bool needs_ids =
      writes(DatasetFormat::coco) && std::ranges::find(options.aovs, Aov::id) == options.aovs.end();
  if (needs_ids) options.aovs.push_back(Aov::id);
  const Camera camera = camera_of(view, size);
  Film film = microtrace::render(*prepared_, camera, size, options);
  apply_display(film, arguments_.display);
  const std::string stem = stem_of(arguments_, view, index);
  std::vector<std::string> names;
  if (writes(DatasetFormat::coco))
    names.push_back(save_annotations(view, {.index = index, .camera = camera}, film, folder));
  if (needs_ids)
    std::erase_if(film.channels, [](const Channel& c) { return c.name.starts_with("id."); });
  for (const DatasetFormat format : arguments_.dataset.formats) {
    if (format != DatasetFormat::coco) names.push_back(save(film, format, stem, folder));
  }
  return names;
}

}  // namespace microtrace::cli
