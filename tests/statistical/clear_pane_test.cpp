// Tests light that crosses thin smooth walls in straight lines.

#include "scene/math/luminance.hpp"
#include "support/pi.hpp"
#include "support/pictures.hpp"
#include "support/shading/bodies.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace microtrace {
namespace {

constexpr Vec3 kAmber(0.8F, 0.5F, 0.2F);

/// Glass that reflects as a dielectric with an index of refraction of 1.5.
Material glass(const Vec3& color) {
  return {.base_color = Vec4(color, 1), .roughness = 0, .transmission = Transmission{.factor = 1}};
}

/// Glass that reflects nothing, so that it transmits its color from all directions.
Material filter(const Vec3& color) {
  Material result = glass(color);
  result.specular = Specular{.factor = 0};
  return result;
}

/// The fraction of light that glass transmits at an angle (Schlick's term).
double transmitted(double cosine) {
  return 0.96 * (1 - std::pow(1 - cosine, 5));
}

/// A horizontal sheet that faces up.
Mesh sheet(float height) {
  return parallelogram({-900, height, 900}, {1800, 0, 0}, {0, 0, -1800});
}

/// A matte gray floor around the origin under horizontal panes at these heights.
Scene floor_under(const std::vector<std::pair<float, Material>>& panes) {
  Scene scene;
  scene.materials = {{.base_color = {0.5F, 0.5F, 0.5F, 1}, .specular = Specular{.factor = 0}}};
  scene.objects.push_back({.shape = sheet(0), .material = 0});
  for (const auto& [height, material] : panes) {
    scene.objects.push_back(
        {.shape = sheet(height), .material = static_cast<std::uint32_t>(scene.materials.size())});
    scene.materials.push_back(material);
  }
  scene.environment = Environment{.content = Vec3(0)};
  return scene;
}

/// Adds a sun at an angle from the zenith.
void add_sun(Scene& scene, double angle) {
  const Vec3 direction(static_cast<float>(std::sin(angle)), -static_cast<float>(std::cos(angle)),
                       0);
  scene.lights.push_back(
      {.name = "sun", .light = DirectionalLight{.direction = direction, .intensity = 2}});
}

PerspectiveCamera looking_down_from(double height) {
  return {.pose = {.position = {0, height, 0}, .direction = {0, -1, 0}, .up = {0, 0, 1}},
          .vertical_fov = 0.1};
}

constexpr Shot kDirectLight{.size = {.width = 8, .height = 8}, .samples = 4, .max_depth = 2};

// Without noise, because light samples pass the glass.
TEST(ClearPanes, LetTheSunShineThrough) {
  for (const double angle : {0.0, 0.6, 1.2, 1.5}) {
    for (const int count : {1, 2, 20}) {
      std::vector<std::pair<float, Material>> panes;
      for (int i = 0; i < count; ++i)
        panes.emplace_back(1 + 0.01F * static_cast<float>(i), glass(i == 0 ? kAmber : Vec3(1)));
      Scene scene = floor_under(panes);
      add_sun(scene, angle);
      const double cosine = std::cos(angle);
      const DVec3 expected = DVec3(kAmber) * (0.5 / kPi * 2 * cosine) *
                             std::pow(transmitted(cosine), double{static_cast<double>(count)});
      for (const DVec3& pixel : pixels_of(shoot(scene, looking_down_from(0.5), kDirectLight)))
        for (int c = 0; c < 3; ++c)
          ASSERT_NEAR(pixel[c] / expected[c], 1, 1e-4) << angle << ", " << count << " panes";
    }
  }
}

/// Lights of one kind, and what it is.
struct Lights {
  const char* name;
  void (*add)(Scene&);
};

void add_lamp(Scene& scene, const Shape& shape) {
  scene.objects.push_back(
      {.shape = shape, .material = static_cast<std::uint32_t>(scene.materials.size())});
  scene.materials.push_back({.base_color = {0, 0, 0, 1}, .emissive = Vec3(20)});
}

constexpr std::array kLights{
    Lights{"sun", [](Scene& scene) { add_sun(scene, 0.5); }},
    Lights{"bulb",
           [](Scene& scene) {
             scene.lights.push_back(
                 {.name = "bulb", .light = PointLight{.position = {1, 4, 0}, .intensity = 50}});
           }},
    Lights{"mesh",
           [](Scene& scene) {
             add_lamp(scene, parallelogram({-1, 3, -1}, {2, 0, 0}, {0, 0, 2}));
           }},
    Lights{"ball",
           [](Scene& scene) {
             add_lamp(scene, Sphere{{0, 4, 1}, 1});
           }},
    Lights{"sky",
           [](Scene& scene) { scene.environment = Environment{.content = Vec3(0.5F, 1, 2)}; }},
    Lights{"map", [](Scene& scene) {
             RadianceMap map{.width = 16, .height = 8};
             for (std::uint32_t i = 0; i < 16 * 8; ++i)
               map.pixels.emplace_back(i == 37 ? 40.0F : 0.5F);
             scene.environment = Environment{.content = std::make_shared<const RadianceMap>(map)};
           }}};

/// The shapes of a pane that covers the floor. All but the first are not meshes, so that no query
/// passes them.
std::vector<std::pair<std::string, std::vector<Shape>>> panes() {
  return {{"mesh", {sheet(2)}},
          {"plane", {Plane{.point = {0, 2, 0}, .normal = {0, 1, 0}}}},
          {"triangles",
           {Triangle{{-900, 2, 900}, {900, 2, 900}, {900, 2, -900}},
            Triangle{{-900, 2, 900}, {900, 2, -900}, {-900, 2, -900}}}}};
}

// Glass that reflects nothing has the effect of a filter before all lights, which are found by
// light samples and by paths.
TEST(ClearPanes, FilterTheLightOfAllLights) {
  for (const auto& [name, add] : kLights) {
    for (const auto& [kind, shapes] : panes()) {
      Scene bare = floor_under({}), covered = floor_under({});
      add(bare), add(covered);
      for (const Shape& shape : shapes)
        covered.objects.push_back(
            {.shape = shape, .material = static_cast<std::uint32_t>(covered.materials.size())});
      covered.materials.push_back(filter(kAmber));
      Shot shot{.size = {.width = 4, .height = 4}, .samples = 256, .max_depth = 2};
      const DVec3 direct = mean_of(shoot(bare, looking_down_from(0.5), shot));
      const DVec3 below = mean_of(shoot(covered, looking_down_from(0.5), shot));
      shot.samples = 1024;
      const DVec3 above = mean_of(shoot(covered, looking_down_from(2.5), shot));
      for (int c = 0; c < 3; ++c) {
        EXPECT_GT(direct[c], 0.05) << name;
        EXPECT_NEAR(below[c] / direct[c], double{kAmber[c]}, 0.005) << name << ", " << kind;
        EXPECT_NEAR(above[c] / direct[c], double{kAmber[c]} * double{kAmber[c]}, 0.01)
            << name << ", " << kind;
      }
    }
  }
}

// Lights and the environment that a camera sees through glass aren't scattered.
TEST(ClearPanes, ShowWhatIsBehind) {
  Scene scene = floor_under({{1, filter(kAmber)}});
  scene.objects.erase(scene.objects.begin());
  scene.environment = Environment{.content = Vec3(2)};
  const Shot shot{.size = {.width = 8, .height = 8}, .samples = 256, .max_depth = 1};
  const PathIntegrator path({.max_depth = 1});
  Film film = render(scene, looking_down_from(2), shot.size,
                     {.integrator = &path, .samples = shot.samples, .transparent = true});
  EXPECT_EQ(film.alpha_at(3, 4), 1);
  const DVec3 sky = mean_of(film);
  add_lamp(scene, sheet(0));
  const DVec3 lamp = mean_of(shoot(scene, looking_down_from(2), shot));
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(sky[c] / (2 * double{kAmber[c]}), 1, 0.01);
    EXPECT_NEAR(lamp[c] / (20 * double{kAmber[c]}), 1, 0.01);
  }
}

// Light that doesn't cross glass is reflected or, by the opaque part, scattered.
TEST(ClearPanes, ReflectAndScatterTheRest) {
  for (const float factor : {1.0F, 0.5F, 0.01F}) {
    Material material = glass(kAmber);
    material.transmission->factor = factor;
    Scene scene = floor_under({{1, material}});
    scene.objects.erase(scene.objects.begin());
    scene.environment = Environment{.content = Vec3(1)};
    const DVec3 got = mean_of(
        shoot(scene, looking_down_from(2), {.size = {.width = 8, .height = 8}, .samples = 1024}));
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(got[c], 0.04 + 0.96 * double{kAmber[c]}, 0.004) << factor;
  }
}

// White glass whose normal texture tilts it under a coat that keeps the geometric normal. Where the
// glass leans away from the camera, the coat absorbs light that the glass reflects at grazing
// angles.
TEST(ClearPanes, GainNoEnergyUnderCoats) {
  const auto light = [](double elevation, double tilt) {
    Scene scene;
    const auto channel = [](double x) {
      return static_cast<std::uint8_t>(127.5 + 127.5 * x + 0.5);
    };
    scene.images.push_back(std::make_shared<const Image>(
        Image{.width = 1,
              .height = 1,
              .channels = 3,
              .samples = std::vector<std::uint8_t>{channel(std::sin(tilt)), channel(0),
                                                   channel(std::cos(tilt))}}));
    scene.textures.push_back({.image = 0});
    Material material = glass(Vec3(1));
    material.ior = 1;
    material.normal_texture = TextureUse{};
    material.clearcoat = Clearcoat{.factor = 1};
    scene.materials = {material};
    Mesh pane = parallelogram({-50, 0, 50}, {100, 0, 0}, {0, 0, -100});
    pane.uv_sets = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    pane.normals.assign(4, Vec3(0, 1, 0));
    pane.tangents.assign(4, Vec4(1, 0, 0, 1));
    scene.objects.push_back({.shape = pane, .material = 0});
    scene.environment = Environment{.content = Vec3(1)};
    const DVec3 direction(-std::cos(elevation), -std::sin(elevation), 0);
    const OrthographicCamera camera{
        .pose = {.position = -direction, .direction = direction, .up = {0, 0, 1}}, .height = 0.1};
    return mean_of(shoot(scene, camera, {.size = {.width = 8, .height = 8}, .samples = 256})).y;
  };
  for (const double elevation : {0.26, 0.5, 1.0}) {
    EXPECT_NEAR(light(elevation, 0.1), 1, 0.01) << elevation;
    EXPECT_LT(light(elevation, -0.17), 1.001) << elevation;
    EXPECT_GT(light(elevation, -0.17), elevation < 0.5 ? 0.6 : 0.94) << elevation;
  }
}

// An invisible pane must not change how bodies around it scatter and absorb light.
TEST(ClearPanes, AreInvisibleInMedia) {
  const Material clear = clear_body(Vec3(0.6F));
  for (const Material& body : {clear, scattering(clear, Vec3(0.9F, 0.6F, 0.3F))}) {
    const auto brightness = [&](bool has_pane) {
      Scene scene = ball_under_sky(body);
      if (has_pane) {
        scene.objects.push_back(
            {.shape = parallelogram({-0.7F, 0, 0.7F}, {1.4F, 0, 0}, {0, 0.2F, -1.4F}),
             .material = static_cast<std::uint32_t>(scene.materials.size())});
        scene.materials.push_back(filter(Vec3(1)));
      }
      return estimate(scene, kAcrossBall, {.samples = 64, .max_depth = 64}, kSeeds);
    };
    const Estimate without = brightness(false), with = brightness(true);
    EXPECT_NEAR(with.mean, without.mean, kFar * std::hypot(with.deviation, without.deviation));
  }
}

// The shadow catcher shows the fraction of the light's luminance that glass blocks.
TEST(ClearPanes, CastLightShadowsOnTheGround) {
  Scene scene = floor_under({{1, filter(kAmber)}});
  scene.objects.erase(scene.objects.begin());
  add_sun(scene, 0);
  const PathIntegrator path({.ground = Ground{.height = 0}});
  Film film = render(scene, looking_down_from(0.5), {8, 8},
                     {.integrator = &path, .samples = 4, .transparent = true});
  for (std::uint32_t y = 0; y < 8; ++y)
    for (std::uint32_t x = 0; x < 8; ++x)
      EXPECT_NEAR(film.alpha_at(x, y), 1 - luminance(kAmber), 1e-5F);
}

}  // namespace
}  // namespace microtrace
