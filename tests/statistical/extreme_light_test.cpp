/// Tests lights with extreme float32 parameters: minimum and maximum sizes, intensities and
/// distances.
#include "render/lights/light_tree.hpp"
#include "render/prepared/content.hpp"
#include "support/pictures.hpp"
#include "support/shading/light_samples.hpp"

#include <microtrace/path.hpp>
#include <microtrace/prepared_scene.hpp>
#include <microtrace/render.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace microtrace {
namespace {

constexpr float kMax = std::numeric_limits<float>::max();

/// Generates numbers of all magnitudes, often equal ones or ends of the float32 range.
struct Extremes {
  explicit Extremes(unsigned seed) : bits(seed) {}

  std::mt19937 bits;

  std::size_t below(std::size_t n) { return bits() % n; }
  float unit() { return static_cast<float>(bits() >> 8U) * 0x1p-24F; }

  float positive() {
    static constexpr std::array kEnds = {0x1p-149F, 0x1p-148F, 0x1p-126F, 3e-38F,  4e-38F, 0x1p-64F,
                                         1.0F,      1e9F,      0x1p64F,   1.7e38F, 3e38F,  kMax};
    if (below(3) != 0) return kEnds[below(kEnds.size())];
    return std::ldexp(1 + unit(), static_cast<int>(below(276)) - 149);
  }
  float at_least_0() { return below(6) == 0 ? 0 : positive(); }
  float any() { return below(2) == 0 ? at_least_0() : -at_least_0(); }
  Vec3 place() {
    if (below(4) == 0) return Vec3(any());
    return {any(), any(), any()};
  }
  /// Returns a point whose coordinates equal those of p or are neighboring numbers.
  Vec3 place_near(const Vec3& p) {
    Vec3 result = p;
    for (int i = 0; i < 3; ++i)
      if (below(2) == 0) result[i] = std::nextafter(result[i], below(2) == 0 ? kMax : -kMax);
    return result;
  }
  Vec3 direction() {
    if (below(4) == 0) {
      Vec3 axis(0);
      axis[static_cast<int>(below(3))] = below(2) == 0 ? 1.0F : -1.0F;
      return axis;
    }
    const Vec3 v = Vec3(unit(), unit(), unit()) - 0.5F;
    const float square = glm::dot(v, v);
    return square > 0 ? v / std::sqrt(square) : Vec3(0, 0, 1);
  }
};

bool is_finite(const Vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
bool is_light(const Vec3& v) {
  return is_finite(v) && v.x >= 0 && v.y >= 0 && v.z >= 0;
}

std::vector<LightBounds> lights(Extremes& random, std::size_t count) {
  std::vector<LightBounds> result;
  Vec3 last(0);
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 a = random.below(3) == 0 ? random.place_near(last) : random.place();
    const Vec3 b = random.below(2) == 0 ? a : random.place_near(a);
    last = a;
    result.push_back({.low = glm::min(a, b),
                      .high = glm::max(a, b),
                      .power = double{random.positive()} *
                               (random.below(2) == 0 ? 1 : double{random.positive()}),
                      .cone = {.axis = random.direction(),
                               .cos_o = random.below(3) == 0 ? -1 : 2 * random.unit() - 1},
                      .two_sided = random.below(4) == 0});
  }
  return result;
}

/// A light's importance in float64, and the importance without its cosine factors.
struct Importance {
  double value = 0, head_on = 0;
};
Importance importance(const LightBounds& light, const Vec3& p, const Vec3& n) {
  const DVec3 low(light.low), high(light.high), way = DVec3(p) - (low + high) / 2.0;
  const double radius_square = glm::dot(high - low, high - low) / 4, square = glm::dot(way, way);
  Importance result{.head_on = light.power / std::max(square, radius_square)};
  if (square == 0) return {};
  const DVec3 direction = way / std::sqrt(square);
  const double box = std::asin(std::sqrt(std::min(radius_square / square, 1.0)));
  const double along = std::clamp(glm::dot(DVec3(light.cone.axis), direction), -1.0, 1.0);
  const double off_axis = std::acos(light.two_sided ? std::abs(along) : along);
  const double off_cone = std::max(off_axis - std::acos(double{light.cone.cos_o}) - box, 0.0);
  const double arriving = std::acos(std::min(std::abs(glm::dot(DVec3(n), direction)), 1.0));
  const double least = square <= radius_square ? 1 : std::cos(off_cone);
  const double least_arriving =
      square <= radius_square ? 1 : std::cos(std::max(arriving - box, 0.0));
  if (least < light.cone.cos_e || least < 0 || least_arriving < 0) return result;
  result.value = result.head_on * least * least_arriving;
  return result;
}

// The probability need not be positive for lights at grazing angles, whose importance is below the
// rounding error.
TEST(ExtremeLights, ProbabilitiesAddUpToOne) {
  for (unsigned seed = 0; seed < 3000; ++seed) {
    Extremes random(seed);
    const std::size_t count = 1 + random.below(seed % 10 == 0 ? 200 : 12);
    const std::vector<LightBounds> all = lights(random, count);
    const LightTree tree(all);
    for (int i = 0; i < 4; ++i) {
      const Vec3 p = i == 0 ? all[random.below(count)].low : random.place(), n = random.direction();
      const float total =
          LightNodes<1>(*tree.nodes()).importance(in_tree_units<1>(tree.space(), p), n);
      ASSERT_TRUE(std::isfinite(total) && total >= 0) << seed;
      double sum = 0;
      for (std::size_t light = 0; light < count; ++light) {
        const float probability = tree.probability(light, p, n);
        ASSERT_TRUE(probability >= 0 && probability <= 1) << seed;
        if (const auto [value, head_on] = importance(all[light], p, n); value > 1e-6 * head_on) {
          EXPECT_GT(probability, 0) << seed << " " << i << " " << light;
        }
        sum += double{probability};
      }
      EXPECT_LE(sum, 1 + 1e-5) << seed;
      double chosen = 0;
      for (int k = 0; k < 100; ++k) {
        const auto choice = chosen_light(tree, p, n, (static_cast<float>(k) + 0.5F) / 100);
        if (!choice) continue;
        ASSERT_LT(choice->light, count);
        ASSERT_EQ(choice->probability, tree.probability(choice->light, p, n)) << seed;
        ASSERT_GT(choice->probability, 0) << seed;
        chosen += 0.01;
      }
      EXPECT_NEAR(sum, chosen, 0.03) << seed;
    }
  }
}

/// Returns a scene with punctual lights, emissive meshes and shapes, and an environment, all of any
/// size and at any position.
Scene scene_of(Extremes& random) {
  Scene scene;
  for (int i = 0; i < 3; ++i) {
    scene.materials.push_back({.base_color = {random.unit(), random.unit(), random.unit(), 1},
                               .double_sided = random.below(2) == 0,
                               .metallic = random.unit(),
                               .roughness = random.unit(),
                               .emissive = Vec3(random.at_least_0(), random.at_least_0(), 0)});
  }
  const std::size_t shapes = random.below(5);
  Vec3 last(0);
  const auto place = [&] {
    return last = random.below(3) == 0 ? random.place_near(last) : random.place();
  };
  for (std::size_t i = 0; i < shapes; ++i) {
    Shape shape = Sphere{place(), random.positive()};
    if (const std::size_t kind = random.below(4); kind == 0) {
      shape = Disc{place(), random.direction(), random.positive()};
    } else if (kind == 1) {
      shape = Triangle{place(), place(), place()};
    } else if (kind == 2) {
      Mesh mesh;
      for (std::uint32_t k = 0; k < 8; ++k) {
        for (std::uint32_t corner = 0; corner < 3; ++corner) mesh.positions.push_back(place());
        mesh.triangles.push_back({3 * k, 3 * k + 1, 3 * k + 2});
      }
      shape = std::move(mesh);
    }
    scene.objects.push_back({.name = "shape",
                             .shape = std::move(shape),
                             .material = static_cast<std::uint32_t>(random.below(3))});
  }
  const std::size_t lamps = random.below(6);
  for (std::size_t i = 0; i < lamps; ++i) {
    const Vec3 color(random.at_least_0(), random.unit(), random.below(2) == 0 ? 0 : 1);
    const std::size_t kind = random.below(3);
    Light light = DirectionalLight{
        .direction = DVec3(random.direction()), .color = color, .intensity = random.at_least_0()};
    if (kind == 1) {
      light =
          PointLight{.position = DVec3(place()), .color = color, .intensity = random.at_least_0()};
    } else if (kind == 2) {
      const double outer = random.below(2) == 0 ? std::numbers::pi / 2 : double{random.unit()};
      light = SpotLight{.position = DVec3(place()) * (random.below(9) == 0 ? 0x1p300 : 1),
                        .direction = DVec3(random.direction()),
                        .color = color,
                        .intensity = random.at_least_0(),
                        .range = random.below(2) == 0 ? double{random.positive()}
                                                      : std::numeric_limits<double>::infinity(),
                        .inner_angle = random.below(2) == 0 ? 0 : std::nextafter(outer, 0.0),
                        .outer_angle = std::max(outer, 0x1p-149)};
    }
    scene.lights.push_back({.name = "lamp", .light = light});
  }
  if (random.below(3) == 0) {
    scene.environment = Environment{.content = Vec3(random.below(2) == 0 ? 0 : 1e9F),
                                    .intensity = random.at_least_0()};
    if (random.below(2) == 0) scene.environment->content = Studio{};
  }
  return scene;
}

TEST(ExtremeLights, SamplesAreFinite) {
  for (unsigned seed = 0; seed < 4000; ++seed) {
    Extremes random(seed);
    const Scene scene = scene_of(random);
    const PreparedScene prepared(scene, {.threads = 1});
    const Lighting lighting = prepared.content().lighting({});
    for (int i = 0; i < 30; ++i) {
      const LightSampleContext context{.p = random.place(), .n = random.direction()};
      const auto light =
          light_sample(lighting, context, {random.unit(), random.unit()}, random.unit());
      if (!light) continue;
      ASSERT_TRUE(is_light(light->light)) << seed;
      ASSERT_NEAR(glm::dot(light->wi, light->wi), 1, 1e-4) << seed;
      ASSERT_TRUE(is_finite(light->to_light) && light->to_light != Vec3(0)) << seed;
      ASSERT_TRUE(std::isfinite(light->pdf * light->pdf)) << seed;
      if (!light->target) continue;
      ASSERT_GT(light->pdf * light->pdf, 0) << seed;
      const float other = lighting.emitter_pdf(*light->target, context, random.positive(),
                                               std::max(random.unit(), 0x1p-24F));
      ASSERT_TRUE(std::isfinite(other * other)) << seed;
      ASSERT_GT(other * other, 0) << seed;
    }
  }
}

TEST(ExtremeLights, PicturesAreFinite) {
  const PathIntegrator path;
  int lit = 0;
  for (unsigned seed = 0; seed < 1000; ++seed) {
    Extremes random(seed);
    Scene scene = scene_of(random);
    const Vec3 p = scene.lights.empty() || random.below(2) == 0
                       ? random.place()
                       : std::visit(
                             [](const auto& light) {
                               if constexpr (requires { light.position; })
                                 return finite_point(light.position);
                               else
                                 return Vec3(0);
                             },
                             scene.lights[0].light);
    const float height = random.positive();
    const Vec3 floor(p.x, std::max(p.y - random.at_least_0(), -kMax), p.z);
    scene.objects.push_back({.name = "floor", .shape = Plane{floor, {0, 1, 0}}, .material = 0});
    const Vec3 eye(p.x, std::min(floor.y + random.positive(), kMax), p.z);
    const OrthographicCamera camera{
        .pose = {.position = DVec3(eye), .direction = {0, -1, 0}, .up = {0, 0, -1}},
        .height = double{height}};
    RenderCounts counts;
    Film film = render(scene, camera, {.width = 4, .height = 4},
                       {.threads = 1, .integrator = &path, .samples = 4, .counts = &counts});
    EXPECT_EQ(counts.invalid_samples, 0U) << seed;
    bool is_lit = false;
    for (const DVec3& pixel : pixels_of(film)) {
      ASSERT_TRUE(is_light(Vec3(pixel))) << seed;
      is_lit |= pixel != DVec3(0);
    }
    lit += is_lit ? 1 : 0;
  }
  EXPECT_GT(lit, 300);
}

}  // namespace
}  // namespace microtrace
