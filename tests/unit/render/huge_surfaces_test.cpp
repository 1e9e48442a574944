// Checks that triangles too large for a tree are culled, cut out and blended like others. Before,
// rays met them as opaque in scenes of few primitives, which keep them beside the tree.

#include <microtrace/camera.hpp>
#include <microtrace/path.hpp>
#include <microtrace/prepared_scene.hpp>
#include <microtrace/render.hpp>

#include <utility>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

Mesh quad(float size, float y, bool faces_down) {
  Mesh mesh;
  mesh.positions = {{-size, y, -size}, {size, y, -size}, {size, y, size}, {-size, y, size}};
  if (faces_down)
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  else
    mesh.triangles = {{0, 2, 1}, {0, 3, 2}};
  return mesh;
}

/// Returns what a sun above a huge quad leaves on a floor below it, which a camera between both
/// sees, and the alpha of the quad as seen from above.
std::pair<float, float> light_and_alpha(const Material& material, float size, int others) {
  Scene scene;
  scene.materials = {Material{.base_color = Vec4(0.8F, 0.8F, 0.8F, 1)}, material};
  scene.objects.push_back({.name = "", .shape = quad(10, 0, false), .material = 0});
  for (int i = 0; i < others; ++i)
    scene.objects.push_back(
        {.name = "", .shape = quad(0.01F, -5.0F - static_cast<float>(i), false), .material = 0});
  scene.objects.push_back({.name = "", .shape = quad(size, 5, true), .material = 1});
  scene.lights = {{.name = "", .light = DirectionalLight{.direction = {0, -1, 0}, .intensity = 3}}};
  const PathIntegrator light(PathOptions{.max_depth = 2});
  PerspectiveCamera camera;
  camera.pose = {.position = {0, 2, 0}, .direction = {0, -1, 0}, .up = {0, 0, 1}};
  camera.vertical_fov = 0.5;
  RenderOptions options{.integrator = &light, .samples = 4, .transparent = true};
  Film below = render(PreparedScene(scene), camera, {.width = 1, .height = 1}, options);
  scene.objects[0].shape = quad(0.01F, -4, false);
  camera.pose.position = {3, 9, 0};
  Film above = render(PreparedScene(scene), camera, {.width = 1, .height = 1}, options);
  return {below.at(0, 0).x, above.alpha_at(0, 0)};
}

TEST(HugeSurfaces, AreLikeOthers) {
  const Vec4 gray(0.5F, 0.5F, 0.5F, 0.25F);
  const Material kinds[] = {
      {.base_color = gray, .double_sided = false},
      {.base_color = gray, .alpha_mode = AlphaMode::mask, .alpha_cutoff = 0.5F},
      {.base_color = gray, .alpha_mode = AlphaMode::blend},
  };
  for (const Material& material : kinds) {
    const auto expected = light_and_alpha(material, 1e6F, 0);
    for (const float size : {2e11F, 3e11F, 1e15F}) {
      for (const int others : {0, 20}) {
        SCOPED_TRACE(size);
        const auto actual = light_and_alpha(material, size, others);
        EXPECT_NEAR(actual.first, expected.first, 1e-5);
        EXPECT_NEAR(actual.second, expected.second, 1e-5);
      }
    }
    EXPECT_GT(expected.first, 0.1F);
  }
}

}  // namespace
}  // namespace microtrace
