// Checks that a host program's rounding mode, precision, traps and flushing of subnormals change no
// result, and that they are restored afterwards.

#include "base/system/float_environment.hpp"

#include "support/host_rules.hpp"
#include "support/source_folder.hpp"

#include <microtrace/camera.hpp>
#include <microtrace/framing.hpp>
#include <microtrace/io.hpp>
#include <microtrace/path.hpp>
#include <microtrace/render.hpp>
#include <microtrace/sample_sums.hpp>

#include <cfenv>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

using tests::HostRules;

INSTANTIATE_TEST_SUITE_P(Rounding, HostRules,
                         testing::Values(FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO));

std::vector<Vec3> picture(const char* name) {
  const Scene scene = load_scene(tests::source_folder() / "scenes" / name).scene;
  const Film film = render(scene, scene.cameras[0].camera, scene.size, {.threads = 2});
  std::vector<Vec3> pixels;
  for (std::uint32_t y = 0; y < film.size().height; ++y)
    pixels.insert(pixels.end(), film.row(y).begin(), film.row(y).end());
  return pixels;
}

TEST_P(HostRules, ChangeNoPicture) {
  for (const char* name : {"degenerate/subnormal.json", "perspective1.json", "gltf/knot.glb"}) {
    const std::vector<Vec3> expected = picture(name);
    set();
    const std::vector<Vec3> actual = picture(name);
    expect_kept();
    TearDown();
    EXPECT_TRUE(actual == expected) << name;
  }
}

// A scene whose decimal numbers have no exact binary values, with lights and materials of many
// kinds. It has no camera, so that one is computed. Every step from text to picture bytes thus
// computes something.
constexpr const char* kLit = R"({
  "version": 1,
  "image": {"width": 24, "height": 18},
  "materials": {
    "floor": {"base_color": [0.61, 0.58, 0.55], "roughness": 0.83},
    "glass": {"roughness": 0.1, "transmission": 0.9, "ior": 1.52,
              "volume": {"attenuation_distance": 1.3, "attenuation_color": [0.9, 0.6, 0.3]}},
    "coat": {"base_color": [0.5, 0.04, 0.08], "roughness": 0.47, "clearcoat": {"factor": 0.9, "roughness": 0.1},
             "sheen": {"color": [0.6, 0.5, 0.9], "roughness": 0.4}},
    "film": {"metallic": 1, "roughness": 0.17, "iridescence": {"factor": 0.7, "thickness": 353}},
    "lamp": {"base_color": [0, 0, 0], "emissive": [6.1, 5.3, 4.7]}
  },
  "lights": [
    {"type": "directional", "direction": [-0.5, -1, -0.6], "color": [1, 0.95, 0.85], "intensity": 1.2},
    {"type": "spot", "position": [2.1, 4.3, 3], "direction": [-0.1, -1, -0.8], "inner_angle": 8.3,
     "outer_angle": 40.7, "intensity": 41}
  ],
  "environment": {"type": "studio", "intensity": 0.7},
  "objects": [
    {"type": "disc", "center": [0.1, -1.1, 0], "normal": [0.1, 1, 0.1], "radius": 4.3, "material": "floor"},
    {"type": "sphere", "center": [-1.9, 0.1, 0.3], "radius": 0.93, "material": "glass"},
    {"type": "quadric", "coefficients": {"a": 1.1, "b": 0.9, "c": 1.3, "d": 0.1, "j": -0.7}, "material": "coat"},
    {"type": "mesh", "file": "gltf/cube.glb", "material": "film",
     "transform": {"translation": [2.3, -0.4, 0.2], "rotation": {"axis": [0.3, 1, 0.2], "angle": 29.3},
                   "scale": 0.57}},
    {"type": "triangle", "a": [-1.2, 2.6, -0.7], "b": [1.3, 2.7, -0.9], "c": [0.1, 2.4, 0.8], "material": "lamp"}
  ]
})";

std::string lit_ppm(const Scene& scene) {
  const PathIntegrator light;
  const Film film = render(scene, default_camera(scene, {24, 18}), {24, 18},
                           {.threads = 2, .integrator = &light, .samples = 4});
  return encode_ppm(film);
}

/// Returns the folder of scenes. It is computed only once, because the standard library computes
/// path capacities in floating point, which the host's traps would abort.
const std::filesystem::path& scenes_folder() {
  static const std::filesystem::path folder = tests::source_folder() / "scenes";
  return folder;
}

std::string lit_json_ppm() {
  return lit_ppm(parse_scene(kLit, "lit.json", scenes_folder()).scene);
}

std::string lit_gltf_ppm() {
  return lit_ppm(load_scene(tests::source_folder() / "scenes/gltf/textures.glb").scene);
}

TEST_P(HostRules, ChangeNoPathTracedPicture) {
  for (const auto& draw : {lit_json_ppm, lit_gltf_ppm}) {
    const std::string expected = draw();
    set();
    const std::string actual = draw();
    expect_kept();
    TearDown();
    EXPECT_TRUE(actual == expected);
  }
}

// Tests the steps that a program may call separately.
TEST_P(HostRules, ChangeNoStep) {
  const auto steps = [] {
    const Scene scene = parse_scene(kLit, "lit.json", scenes_folder()).scene;
    const RayGenerator rays(default_camera(scene, {24, 18}), {24, 18});
    std::vector<double> numbers;
    const auto add = [&](const auto& vector) {
      numbers.insert(numbers.end(), {vector.x, vector.y, vector.z});
    };
    for (int i = 0; i < 10; ++i) {
      const Ray ray = rays(0.3 * i, 0.7 * i);
      add(ray.o);
      add(ray.d);
      add(rays.differential(ray).d_dx);
      numbers.push_back(rays.depth(DVec3(ray.d)));
    }
    PixelSum sum;
    for (const float x : {0.1F, 0.7F, 3.3F}) sum.add(Vec3(x), 0.3F, Vec3(0.2F));
    add(sum.mean_color());
    numbers.insert(numbers.end(),
                   {sum.mean_alpha(), sum.variance(Vec3(0.2F)), sum.mean_luminance(Vec3(0.2F))});
    return numbers;
  };
  const std::vector<double> expected = steps();
  set();
  const std::vector<double> actual = steps();
  expect_kept();
  TearDown();
  EXPECT_EQ(actual, expected);
}

// Parsed numbers could change, because the C library's strtod depends on the x87 rounding mode.
TEST_P(HostRules, ChangeNoParsedNumber) {
  const auto camera = [] {
    const Scene scene =
        parse_scene(R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
            "nodes": [{"camera": 0, "translation": [0.1, 0.3, 0.7]}],
            "cameras": [{"type": "perspective", "perspective": {"yfov": 0.3, "znear": 0.01}}]})",
                    "camera.gltf", "")
            .scene;
    return std::get<PerspectiveCamera>(scene.cameras.at(0).camera);
  };
  const PerspectiveCamera expected = camera();
  set();
  const PerspectiveCamera actual = camera();
  expect_kept();
  TearDown();
  EXPECT_EQ(actual.vertical_fov, expected.vertical_fov);
  EXPECT_EQ(actual.depth.near, expected.depth.near);
  EXPECT_EQ(actual.pose.position, expected.pose.position);
}

// A host may trap its own divisions by zero. The library's divisions must not trigger these traps.
TEST_P(HostRules, TrapsOfTheHostAreRestored) {
  const std::string expected = lit_json_ppm();
  set();
#if defined(__x86_64__)
  constexpr int kTrapped = FE_DIVBYZERO | FE_INVALID | FE_INEXACT | FE_OVERFLOW | FE_UNDERFLOW;
  std::feclearexcept(FE_ALL_EXCEPT);
  feenableexcept(kTrapped);
  const std::string actual = lit_json_ppm();
  EXPECT_EQ(fegetexcept(), kTrapped);
  fedisableexcept(FE_ALL_EXCEPT);
#else
  const std::string actual = lit_json_ppm();
#endif
  expect_kept();
  TearDown();
  EXPECT_TRUE(actual == expected);
}

}  // namespace
}  // namespace microtrace
