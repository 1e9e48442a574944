#include "cli/report/scene_summary.hpp"

#include "base/counted.hpp"
#include "base/text/printable.hpp"
#include "cli/report/warnings.hpp"

#include <algorithm>
#include <cstdio>
#include <string>
#include <variant>

namespace microtrace::cli {
namespace {

void print_info(const std::string& text) {
  std::fprintf(stderr, "info: %s\n", printable(text).c_str());
}

/// Returns the numbers of primitives of each kind.
std::string primitives_text(const Scene& scene) {
  std::size_t triangles = 0, segments = 0, others = 0;
  for (const ObjectRun& run : scene.objects.runs()) {
    const std::size_t count = primitive_count(run);
    if (const PlacedMesh mesh = run.mesh(0)) {
      triangles += count;
      segments += mesh.arrays->segments.size();
    } else {
      others += count;
    }
  }
  std::string text = counted(triangles, "triangle") + " in meshes";
  if (segments > 0) text += ", " + std::to_string(segments) + " lines and points";
  return text + ", " + counted(others, "other shape");
}

std::string images_text(const Scene& scene) {
  std::size_t decoded = 0;
  std::uint32_t side = 0;
  for (const auto& image : scene.images) {
    if (!image) continue;
    ++decoded;
    side = std::max({side, image->width, image->height});
  }
  std::string text = counted(scene.images.size(), "image");
  if (!scene.images.empty()) text += ", " + std::to_string(decoded) + " of them decoded";
  if (decoded > 0) text += " (sides up to " + std::to_string(side) + ")";
  return text;
}

std::string camera_text(const Arguments& arguments, const Scene& scene) {
  const CameraOptions& options = arguments.camera;
  if (options.eye) return "--eye";
  if (options.orbit) return options.orbit->distance ? "--view" : "--view, the scene is framed";
  if (!options.camera.empty()) return options.camera;
  if (scene.cameras.empty()) return "none, the scene is framed";
  return scene.cameras[0].name + ", the first of " + std::to_string(scene.cameras.size());
}

std::string integrator_text(const Arguments& arguments) {
  if (const auto* aov = std::get_if<Aov>(&*arguments.integrator)) return std::string(name_of(*aov));
  return arguments.is_path_traced() ? "path" : "flat";
}

}  // namespace

void print_scene_summary(const Arguments& arguments, const Scene& scene, ImageSize size) {
  print_info(arguments.scene + ": " + counted(scene.objects.size(), "object") + ": " +
             primitives_text(scene));
  print_info(counted(scene.materials.size(), "material") + ", " +
             counted(scene.textures.size(), "texture") + ", " + images_text(scene));
  print_info("light: " + lights_text(scene));
  print_info("camera: " + camera_text(arguments, scene));
  print_info("picture: " + std::to_string(size.width) + " x " + std::to_string(size.height) + ", " +
             integrator_text(arguments));
}

}  // namespace microtrace::cli
