#pragma once
/// Rendered views for the tests of annotations.

#include "dataset/annotations/drawn_view.hpp"
#include "dataset/annotations/masks.hpp"

#include <microtrace/render_aovs.hpp>

#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace microtrace::dataset::tests {

/// A scene with a rendered view of it.
class RenderedView {
 public:
  RenderedView(const Scene& scene, const Camera& camera, ImageSize size, std::uint32_t index = 0)
      : scene_(scene), camera_(camera), size_(size), index_(index) {
    const std::size_t pixels = std::size_t{size.width} * size.height;
    objects_.resize(pixels);
    depth_.resize(pixels);
    const auto stride = std::ptrdiff_t{size.width};
    const std::vector<AovBuffer> buffers{
        {.aov = Aov::id, .data = objects_.data(), .row_stride = stride, .channel = 0},
        {.aov = Aov::depth, .data = depth_.data(), .row_stride = stride}};
    render_aovs(scene_, camera, size, buffers, {.threads = 1});
    for (std::uint32_t& object : objects_) --object;  // 0 becomes kNoObject
  }

  [[nodiscard]] DrawnView view() const {
    return {.index = index_,
            .scene = &scene_,
            .camera = &camera_,
            .size = size_,
            .objects = objects_,
            .depth = depth_,
            .color_file = std::to_string(index_) + ".png"};
  }
  [[nodiscard]] Masks visible() const { return visible_masks(view()); }
  [[nodiscard]] Masks amodal(unsigned threads = 1) const {
    return amodal_masks(view(), {.threads = threads});
  }

 private:
  PreparedScene scene_;
  Camera camera_;
  ImageSize size_;
  std::uint32_t index_;
  std::vector<std::uint32_t> objects_;
  std::vector<float> depth_;
};

using Pixel = std::pair<std::uint32_t, std::uint32_t>;  // y, x

inline std::set<Pixel> pixels_of(const Mask& mask) {
  std::set<Pixel> pixels;
  for (const PixelRun& run : mask.runs()) {
    for (std::uint32_t x = run.x0; x < run.x1; ++x) pixels.emplace(run.y, x);
  }
  return pixels;
}

/// Returns a rectangle in the plane z = `z`, facing +z.
inline Object rectangle(std::string name, const Vec3& low, float width, float height) {
  Mesh mesh;
  mesh.positions = std::vector<Vec3>{low, low + Vec3(width, 0, 0), low + Vec3(width, height, 0),
                                     low + Vec3(0, height, 0)};
  mesh.triangles = std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}};
  return {.name = std::move(name), .shape = std::move(mesh)};
}

/// Returns an orthographic camera that looks along -z, with the scene's origin in the middle of the
/// picture and one pixel per unit.
inline Camera unit_camera(ImageSize size) {
  return OrthographicCamera{.pose = {.position = DVec3(0, 0, 10)},
                            .height = static_cast<double>(size.height)};
}

}  // namespace microtrace::dataset::tests
