#include "base/system/float_environment.hpp"
#include "dataset/annotations/bop.hpp"
#include "dataset/annotations/bop_models.hpp"
#include "dataset/annotations/coco.hpp"
#include "dataset/annotations/masks.hpp"
#include "io/file.hpp"
#include "io/output/atomic_file.hpp"

#include <microtrace/annotations.hpp>

#include <algorithm>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace microtrace {
namespace {

namespace fs = std::filesystem;

std::vector<std::uint32_t> objects_of(const AnnotatedPicture& picture) {
  std::vector<std::uint32_t> objects(picture.ids.size());
  // The id 0 becomes kNoObject.
  static_assert(dataset::kNoObject == std::uint32_t{0} - 1);
  std::ranges::transform(picture.ids, objects.begin(), [](std::uint32_t id) { return id - 1; });
  return objects;
}

/// The result refers to its arguments.
dataset::DrawnView view_of(const PreparedScene& scene, const AnnotatedPicture& picture,
                           const std::vector<std::uint32_t>& objects) {
  return {.index = picture.index,
          .scene = &scene,
          .camera = &picture.camera,
          .size = picture.size,
          .objects = objects,
          .depth = picture.depth,
          .color_file = picture.file};
}

auto reader_of(std::span<const fs::path> parts) {
  return [parts](std::size_t i) { return io::read_file(parts[i], io::kMaxFileSize); };
}

/// Writes what `join` passes to its argument into a file.
template <class Join>
void write_joined(const fs::path& path, const Join& join) {
  io::AtomicFile out(path);
  join([&](std::string_view bytes) { out.write(bytes); });
  out.commit();
}

}  // namespace

void require_bop_camera(const Camera& camera, const std::string& place) {
  const auto* calibrated = std::get_if<CalibratedCamera>(&camera);
  const bool is_plain =
      calibrated != nullptr && calibrated->distortion == Distortion(RationalDistortion{});
  if (std::holds_alternative<PerspectiveCamera>(camera) || is_plain) return;
  throw Error(
      ErrorKind::usage, place,
      "BOP describes cameras by a matrix K; use a perspective camera or a calibrated camera "
      "without distortion");
}

Annotations annotate(const PreparedScene& scene, const AnnotatedPicture& picture,
                     const AnnotationFormats& formats, unsigned threads) {
  const FloatEnvironment environment;
  const std::vector<std::uint32_t> objects = objects_of(picture);
  const dataset::DrawnView view = view_of(scene, picture, objects);
  const dataset::Masks visible = dataset::visible_masks(view);
  dataset::Masks amodal;
  if (formats.bop_depth_scale || (formats.coco && formats.coco->amodal)) {
    QueryOptions options;
    options.threads = threads;
    amodal = dataset::amodal_masks(view, options);
  }
  Annotations result;
  if (formats.coco) {
    result.coco = dataset::coco_part(view, formats.coco->categories, visible,
                                     formats.coco->amodal ? &amodal : nullptr);
  }
  if (formats.bop_depth_scale) {
    result.bop = dataset::bop_view(view, dataset::BopFrames(scene.scene()), visible, amodal,
                                   {.depth_scale = *formats.bop_depth_scale});
  }
  return result;
}

void join_coco(std::span<const fs::path> parts, const Scene& scene, CocoCategories categories,
               const fs::path& output) {
  dataset::Categories of_scene(categories);
  of_scene.add(scene);
  write_joined(output, [&](const auto& out) {
    dataset::join_coco(of_scene, parts.size(), reader_of(parts), out);
  });
}

void join_bop(std::span<const fs::path> parts, const fs::path& folder) {
  using dataset::BopFile;
  const auto write = [&](BopFile file, const char* name) {
    write_joined(folder / name, [&](const auto& out) {
      dataset::join_bop(file, parts.size(), reader_of(parts), out);
    });
  };
  write(BopFile::scene_camera, "scene_camera.json");
  write(BopFile::scene_gt, "scene_gt.json");
  write(BopFile::scene_gt_info, "scene_gt_info.json");
}

std::vector<NamedFile> bop_models(const Scene& scene) {
  const FloatEnvironment environment;
  const dataset::BopFrames frames(scene);
  std::vector<NamedFile> files;
  std::vector<dataset::BopModel> models;
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
    std::optional<dataset::BopModel> model = dataset::bop_model(scene, i, frames);
    if (!model) continue;
    files.push_back(std::move(model->file));
    models.push_back(std::move(*model));
  }
  files.push_back({"models/models_info.json", dataset::bop_models_info(models)});
  return files;
}

}  // namespace microtrace
