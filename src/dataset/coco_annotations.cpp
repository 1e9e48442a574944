#include "dataset/annotations/coco.hpp"
#include "dataset/annotations/masks.hpp"
#include "io/atomic_file.hpp"
#include "io/file.hpp"

#include <microtrace/coco.hpp>

#include <algorithm>
#include <vector>

namespace microtrace {
namespace {

dataset::Categories categories_of(const Scene& scene, CocoCategories kind) {
  dataset::Categories categories(kind == CocoCategories::materials
                                     ? dataset::CategoryBy::material_name
                                     : dataset::CategoryBy::object_name);
  categories.add(scene);
  return categories;
}

}  // namespace

std::string coco_annotations(const PreparedScene& scene, const CocoPicture& picture,
                             const CocoOptions& options) {
  std::vector<std::uint32_t> objects(picture.ids.size());
  // The id 0 becomes kNoObject.
  static_assert(dataset::kNoObject == std::uint32_t{0} - 1);
  std::ranges::transform(picture.ids, objects.begin(), [](std::uint32_t id) { return id - 1; });
  const dataset::DrawnView view{.index = picture.index,
                                .name = "",
                                .scene = &scene,
                                .camera = &picture.camera,
                                .size = picture.size,
                                .objects = objects,
                                .depth = {},
                                .color_file = picture.file};
  dataset::Masks amodal;
  if (options.amodal) {
    QueryOptions query;
    query.threads = options.threads;
    amodal = dataset::amodal_masks(scene, picture.camera, picture.size, query);
  }
  return dataset::coco_part(view, categories_of(scene.scene(), options.categories),
                            dataset::visible_masks(view), options.amodal ? &amodal : nullptr);
}

void join_coco(std::span<const std::filesystem::path> parts, const Scene& scene,
               CocoCategories categories, const std::filesystem::path& output) {
  io::AtomicFile out(output);
  dataset::join_coco(
      categories_of(scene, categories), parts.size(),
      [&](std::size_t i) { return io::read_file(parts[i], io::kMaxFileSize); },
      [&](std::string_view bytes) { out.write(bytes); });
  out.commit();
}

}  // namespace microtrace
