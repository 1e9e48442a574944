// Writes a small data set for judges_test.py: write_data_set FOLDER
#include "dataset/annotations/bop.hpp"
#include "dataset/annotations/bop_models.hpp"
#include "dataset/annotations/coco.hpp"
#include "dataset/annotations/npz.hpp"
#include "views.hpp"

#include <filesystem>
#include <fstream>
#include <iostream>

namespace microtrace::dataset::tests {
namespace {

void write(const std::filesystem::path& folder, const NamedFile& file) {
  const std::filesystem::path path = folder / file.name;
  std::filesystem::create_directories(path.parent_path());
  std::ofstream stream(path, std::ios::binary);
  stream << file.bytes;
  if (!stream.flush()) throw std::runtime_error("can't write " + path.string());
}

/// Tilted rectangles that overlap, far from the world's origin.
Scene tilted_scene() {
  Scene scene;
  scene.origin = {12.5, -3.25, 7};
  for (std::uint32_t k = 0; k < 12; ++k) {
    const auto i = static_cast<float>(k);
    Object object = rectangle(k % 2 == 0 ? "even" : "odd \"" + std::to_string(k) + "\"",
                              {i * 0.4F - 3, i * 0.25F - 2, 0}, 1.5F, 1.25F + 0.1F * i);
    for (Vec3& p : std::get<Mesh>(object.shape).positions.edit())
      p.z = 0.3F * p.x - 0.2F * p.y * static_cast<float>(k % 3) - 0.1F * i;
    scene.objects.push_back(object);
  }
  return scene;
}

void write_data_set(const std::filesystem::path& folder) {
  const Scene scene = tilted_scene();
  Categories categories(CocoCategories::objects);
  categories.add(scene);
  const BopFrames frames(scene);
  const ImageSize size{.width = 97, .height = 65};
  std::vector<std::string> coco_parts, bop_parts;
  for (std::uint32_t i = 0; i < 5; ++i) {
    const Pose pose{.position = {0.5 * i - 1, 0.25 * i, 6.0 + i},
                    .direction = {0.1 - 0.05 * i, 0, -1},
                    .up = {0.1 * i, 1, 0}};
    Camera camera = PerspectiveCamera{.pose = pose, .vertical_fov = 0.8};
    if (i % 2 == 1)
      camera = CalibratedCamera{.pose = pose,
                                .image = {.width = 194, .height = 130},
                                .fx = 150,
                                .fy = 170,
                                .cx = 99,
                                .cy = 60};
    if (i == 4) camera = PerspectiveCamera{.pose = {.position = {0, 0, 6}, .direction = {0, 0, 1}}};
    const RenderedView rendered(scene, camera, size, i);
    const DrawnView view = rendered.view();
    const Masks visible = rendered.visible(), amodal = rendered.amodal();
    coco_parts.push_back(coco_part(view, CocoCategories::objects, visible, &amodal));
    const BopAnnotations bop = bop_view(view, frames, visible, amodal, {.depth_scale = 0.25});
    bop_parts.push_back(bop.part);
    for (const NamedFile& file : bop.files) write(folder / "bop/train/000000", file);
    std::vector<std::uint8_t> whole(scene.objects.size() * view.objects.size());
    for (const ObjectMask& mask : amodal) {
      for (const auto& [y, x] : pixels_of(mask.mask))
        whole[mask.object * view.objects.size() + y * size.width + x] = 1;
    }
    const std::vector<NpzArray> arrays{
        {.name = "objects", .shape = {size.height, size.width}, .values = view.objects},
        {.name = "depth", .shape = {size.height, size.width}, .values = view.depth},
        {.name = "amodal \xC3\xA4",
         .shape = {scene.objects.size(), size.height, size.width},
         .values = std::span<const std::uint8_t>(whole)},
        {.name = "nothing", .shape = {0, 3}, .values = std::span<const float>()},
        {.name = "number", .shape = {}, .values = view.depth.first(1)}};
    write(folder, {.name = std::to_string(i) + ".npz", .bytes = npz(arrays)});
  }
  const auto joined = [](auto&& join, const std::vector<std::string>& parts) {
    std::string text;
    join([&](std::size_t i) { return parts[i]; }, [&](std::string_view bytes) { text += bytes; });
    return text;
  };
  write(folder, {.name = "coco.json",
                 .bytes = joined(
                     [&](const auto& part, const auto& out) {
                       join_coco(categories, coco_parts.size(), part, out);
                     },
                     coco_parts)});
  for (const auto& [name, file] :
       {std::pair("scene_camera", BopFile::scene_camera), std::pair("scene_gt", BopFile::scene_gt),
        std::pair("scene_gt_info", BopFile::scene_gt_info)}) {
    write(folder / "bop/train/000000",
          {.name = std::string(name) + ".json",
           .bytes = joined([&](const auto& part,
                               const auto& out) { join_bop(file, bop_parts.size(), part, out); },
                           bop_parts)});
  }
  std::vector<BopModel> models;
  for (std::uint32_t k = 0; k < scene.objects.size(); ++k) {
    models.push_back(bop_model(scene, k, frames).value());
    write(folder / "bop", models.back().file);
  }
  write(folder / "bop/models", {.name = "models_info.json", .bytes = bop_models_info(models)});
}

}  // namespace
}  // namespace microtrace::dataset::tests

int main(int count, char** arguments) {
  try {
    if (count != 2) throw std::invalid_argument("usage: write_data_set FOLDER");
    microtrace::dataset::tests::write_data_set(arguments[1]);
  } catch (const std::exception& e) {
    std::cerr << e.what() << '\n';
    return 1;
  }
  return 0;
}
