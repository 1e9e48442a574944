#include <microtrace/aov.hpp>
#include <microtrace/error.hpp>
#include <microtrace/io.hpp>
#include <microtrace/render.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace microtrace {
namespace {

constexpr ImageSize kAovSize{.width = 37, .height = 23};
constexpr float kAovInfinity = std::numeric_limits<float>::infinity();

template <typename Number>
const std::vector<Number>& channel(const Film& film, const std::string& name) {
  for (const Channel& c : film.channels) {
    if (c.name == name) return std::get<std::vector<Number>>(c.values);
  }
  throw std::runtime_error("no channel " + name);
}

const std::vector<float>& floats(const Film& film, const std::string& name) {
  return channel<float>(film, name);
}
const std::vector<std::uint32_t>& ids(const Film& film, const char* name) {
  return channel<std::uint32_t>(film, std::string("id.") + name);
}

/// Returns the value of a three-channel AOV at a pixel.
DVec3 triple(const Film& film, const std::string& aov, std::size_t pixel,
             const char* names = "XYZ") {
  DVec3 v;
  for (int i = 0; i < 3; ++i) v[i] = floats(film, aov + "." + names[i])[pixel];
  return v;
}

Film drawn(const Scene& scene, const Camera& camera, RenderOptions options = {}) {
  if (options.aovs.empty()) options.aovs.assign(kAovs.begin(), kAovs.end());
  return render(scene, camera, kAovSize, options);
}

Scene scene_of(std::vector<Shape> shapes) {
  Scene scene;
  for (Shape& shape : shapes)
    scene.objects.push_back(
        {.name = std::to_string(scene.objects.size()), .shape = std::move(shape)});
  return scene;
}

TEST(AovIntegrator, GivesEachInstanceItsOwnColor) {
  constexpr ImageSize kGrid{.width = 200, .height = 100};
  Scene scene;
  for (std::uint32_t y = 0; y < kGrid.height; ++y) {
    for (std::uint32_t x = 0; x < kGrid.width; ++x) {
      const Vec3 corner(x, y, 0);
      scene.objects.push_back({.name = "",
                               .shape = Triangle{corner, corner + Vec3(2, 0, 0) - Vec3(0.1F),
                                                 corner + Vec3(0, 2, 0) - Vec3(0.1F)}});
    }
  }
  const OrthographicCamera camera{.pose = {.position = {100, 50, 5}, .direction = {0, 0, -1}},
                                  .height = 100};
  const AovIntegrator colors(Aov::id);
  const std::string ppm = encode_ppm(render(scene, camera, kGrid, {.integrator = &colors}));
  std::set<std::string> seen;
  for (std::size_t i = ppm.size() - std::size_t{3} * kGrid.width * kGrid.height; i < ppm.size();
       i += 3)
    seen.insert(ppm.substr(i, 3));
  EXPECT_EQ(seen.size(), std::size_t{kGrid.width} * kGrid.height);
}

DVec3 direction_to(std::size_t pixel, const Camera& camera) {
  const RayGenerator rays(camera, kAovSize);
  return glm::normalize(DVec3(rays(static_cast<double>(pixel % kAovSize.width) + 0.5,
                                   static_cast<double>(pixel / kAovSize.width) + 0.5)
                                  .d));
}

TEST(Aov, NamesRoundTrip) {
  for (const Aov aov : kAovs) EXPECT_EQ(aov_named(name_of(aov)), aov);
  EXPECT_EQ(aov_named("color"), std::nullopt);
}

// The wall is at z = -4 and the camera at z = 1, looking along -z, so depth is 5 in every pixel.
TEST(Aov, DepthOfAWallIsItsDistanceAlongTheView) {
  const PerspectiveCamera camera{.pose = {.position = {0, 0, 1}}};
  for (const Shape& wall :
       {Shape(Plane{{0, 0, -4}, {0, 0, 2}}), Shape(Disc{{0, 0, -4}, {0, 0, 3}, 90}),
        Shape(Triangle{{-90, -90, -4}, {90, -90, -4}, {0, 190, -4}})}) {
    const Film film = drawn(scene_of({wall}), camera);
    for (std::size_t i = 0; i < floats(film, "depth.Z").size(); ++i) {
      EXPECT_EQ(floats(film, "depth.Z")[i], 5.0F);
      const DVec3 d = direction_to(i, camera);
      EXPECT_NEAR(floats(film, "distance.T")[i], 5 / -d.z, 2e-6);
      const DVec3 p = triple(film, "position", i);
      EXPECT_EQ(p.z, -4);
      EXPECT_NEAR(p.x, 5 * d.x / -d.z, 2e-6);
      EXPECT_EQ(triple(film, "normal", i), DVec3(0, 0, 1));
      EXPECT_EQ(triple(film, "face_normal", i), DVec3(0, 0, 1));
    }
  }
}

TEST(Aov, PositionsAreInWorldSpace) {
  Scene scene = scene_of({Plane{{0, 0, -4}, {0, 0, 2}}});
  const Film here = drawn(scene, PerspectiveCamera{});
  scene.origin = {1024, -2048, 512};
  const Film there = drawn(scene, PerspectiveCamera{});
  for (std::size_t i = 0; i < floats(here, "depth.Z").size(); ++i) {
    const DVec3 expected = triple(here, "position", i) + scene.origin;
    EXPECT_LT(glm::distance(triple(there, "position", i), expected), 3e-4);
  }
  EXPECT_EQ(floats(there, "depth.Z"), floats(here, "depth.Z"));
}

TEST(Aov, DepthOfOtherCameras) {
  const OrthographicCamera parallel{.pose = {.position = {3, 4, 1}}};
  const Film flat = drawn(scene_of({Plane{{0, 0, -4}, {0, 0, -1}}}), parallel);
  EXPECT_EQ(floats(flat, "depth.Z")[7], 5.0F);
  EXPECT_EQ(floats(flat, "distance.T")[7], 5.0F);
  EXPECT_EQ(triple(flat, "normal", 7), DVec3(0, 0, 1));  // facing the viewer

  const EnvironmentCamera all_around{.pose = {.position = {3, 4, 1}}};
  const Film around = drawn(scene_of({Sphere{{3, 4, 1}, 2}}), all_around);
  for (const float depth : floats(around, "depth.Z")) EXPECT_NEAR(depth, 2, 1e-6);
}

TEST(Aov, NormalsOfASphere) {
  const PerspectiveCamera camera{.pose = {.position = {0.5, 0.25, 6}}, .vertical_fov = 0.5};
  const DVec3 center(0.5, 0, 1);
  const Film film = drawn(scene_of({Sphere{center, 1.5F}}), camera);
  int seen = 0;
  for (std::size_t i = 0; i < floats(film, "depth.Z").size(); ++i) {
    const DVec3 normal = triple(film, "normal", i);
    if (floats(film, "depth.Z")[i] == kAovInfinity) {
      EXPECT_EQ(normal, DVec3(0));
      EXPECT_EQ(floats(film, "distance.T")[i], kAovInfinity);
      EXPECT_EQ(triple(film, "position", i), DVec3(0));
      EXPECT_EQ(ids(film, "instance")[i], 0U);
      continue;
    }
    ++seen;
    const DVec3 p = triple(film, "position", i);
    EXPECT_NEAR(glm::distance(p, center), 1.5, 1e-6);
    EXPECT_LT(glm::distance(normal, (p - center) / 1.5), 1e-6);
    EXPECT_LT(glm::dot(normal, direction_to(i, camera)), 0);
    // The point must lie on the pixel's ray.
    const DVec3 way = p - camera.pose.position;
    EXPECT_LT(glm::length(glm::cross(way, direction_to(i, camera))), 1e-5);
  }
  EXPECT_GT(seen, 300);
  EXPECT_LT(seen, 37 * 23);
}

TEST(Aov, BarycentricsWeighTheCorners) {
  const Triangle t{{-2, -1, -3}, {2, -1.5F, -4}, {0.5F, 2, -3.5F}};
  const Film film = drawn(scene_of({t}), PerspectiveCamera{});
  int seen = 0;
  for (std::size_t i = 0; i < floats(film, "depth.Z").size(); ++i) {
    const DVec3 b = triple(film, "barycentric", i);
    if (ids(film, "instance")[i] == 0) {
      EXPECT_EQ(b, DVec3(0));
      continue;
    }
    ++seen;
    EXPECT_NEAR(b.x + b.y + b.z, 1, 2e-7);
    EXPECT_GE(std::min({b.x, b.y, b.z}), 0);
    const DVec3 p = b.x * DVec3(t.a) + b.y * DVec3(t.b) + b.z * DVec3(t.c);
    EXPECT_LT(glm::distance(p, triple(film, "position", i)), 1e-6);
  }
  EXPECT_GT(seen, 100);
}

/// Returns a mesh of two adjacent triangles with texture coordinates, in front of a floor.
Scene patchwork() {
  Mesh mesh{.positions = {{-1, -1, -2}, {1, -1, -2}, {1, 1, -2}, {-1, 1, -2}},
            .triangles = {{0, 1, 2}, {0, 2, 3}}};
  mesh.uv_sets = {{{0, 1}, {1, 1}, {1, 0}, {0, 0}}};
  Scene scene = scene_of({Plane{{0, -1.5F, 0}, {0, 1, 0}}, mesh});
  scene.materials.push_back({.base_color = {0.5F, 0.25F, 1, 1}});
  scene.materials.push_back({.base_color = {0, 1, 0.5F, 1}});
  scene.objects[1].material = 1;
  return scene;
}

TEST(Aov, IdsAndAlbedoAndTextureCoordinates) {
  const Film film = drawn(patchwork(), PerspectiveCamera{});
  for (std::size_t i = 0; i < floats(film, "depth.Z").size(); ++i) {
    const std::uint32_t instance = ids(film, "instance")[i];
    const DVec3 p = triple(film, "position", i), albedo = triple(film, "albedo", i, "RGB");
    if (instance == 0) {
      EXPECT_EQ(ids(film, "primitive")[i], 0U);
      EXPECT_EQ(albedo, DVec3(0));
    } else if (instance == 1) {
      EXPECT_EQ(ids(film, "primitive")[i], 1U);
      EXPECT_EQ(ids(film, "material")[i], 0U);
      EXPECT_EQ(albedo, DVec3(1));
      EXPECT_EQ(floats(film, "uv.U")[i], 0);
    } else {
      ASSERT_EQ(instance, 2U);
      EXPECT_EQ(ids(film, "primitive")[i], p.y <= p.x ? 1U : 2U);
      EXPECT_EQ(ids(film, "material")[i], 2U);
      EXPECT_EQ(albedo, DVec3(0, 1, 0.5));
      EXPECT_NEAR(floats(film, "uv.U")[i], (p.x + 1) / 2, 1e-6);
      EXPECT_NEAR(floats(film, "uv.V")[i], (1 - p.y) / 2, 1e-6);
    }
  }
  const auto& instances = ids(film, "instance");
  for (const std::uint32_t id : {0U, 1U, 2U}) EXPECT_GT(std::ranges::count(instances, id), 20);
}

TEST(Aov, MaskedAndCulledSurfacesAreTransparent) {
  Scene scene = scene_of({Disc{{0, 0, -2}, {0, 0, 1}, 9}, Disc{{0, 0, -3}, {0, 0, 1}, 9},
                          Disc{{0, 0, -4}, {0, 0, 1}, 9}});
  scene.materials.push_back(
      {.base_color = {1, 1, 1, 0.4F}, .alpha_mode = AlphaMode::mask});  // alpha below the cutoff
  scene.materials.push_back({.base_color = {1, 0, 0, 0.1F}, .alpha_mode = AlphaMode::blend});
  scene.objects[0].material = 0;
  scene.objects[1].material = 1;
  Film film = drawn(scene, PerspectiveCamera{});
  EXPECT_EQ(ids(film, "instance")[100], 2U);
  EXPECT_EQ(floats(film, "depth.Z")[100], 3);
  scene.materials[0].base_color.w = 0.5F;
  film = drawn(scene, PerspectiveCamera{});
  EXPECT_EQ(ids(film, "instance")[100], 1U);
}

TEST(Aov, SamplesThreadsAndCropHaveNoEffect) {
  const Scene scene = patchwork();
  const Film one = drawn(scene, PerspectiveCamera{}, {.threads = 1});
  const Film many = drawn(scene, PerspectiveCamera{}, {.threads = 3, .samples = 7});
  const PixelRect crop{5, 3, 30, 19};
  const Film part = drawn(scene, PerspectiveCamera{}, {.threads = 2, .crop = crop});
  ASSERT_EQ(one.channels.size(), 22U);
  for (std::size_t c = 0; c < one.channels.size(); ++c) {
    SCOPED_TRACE(one.channels[c].name);
    EXPECT_EQ(one.channels[c].name, many.channels[c].name);
    EXPECT_EQ(one.channels[c].values, many.channels[c].values);
    std::visit(
        [&](const auto& whole) {
          const auto& cut = std::get<std::remove_cvref_t<decltype(whole)>>(part.channels[c].values);
          std::size_t i = 0;
          for (std::uint32_t y = crop.y0; y < crop.y1; ++y) {
            for (std::uint32_t x = crop.x0; x < crop.x1; ++x)
              EXPECT_EQ(cut[i++], whole[std::size_t{y} * kAovSize.width + x]);
          }
          EXPECT_EQ(i, cut.size());
        },
        one.channels[c].values);
  }
}

// More samples make each sample's texture footprint smaller, which moves the edges of alpha masks
// in the color image. AOVs of exact quantities must not change.
TEST(Aov, SamplesDoNotChangeCutOuts) {
  Image image{.width = 64, .height = 64, .channels = 4};
  std::vector<std::uint8_t> pixels;
  for (std::uint32_t i = 0; i < 64 * 64; ++i) {
    const std::uint32_t mixed = i * 2654435761U;
    for (int shift : {8, 16, 20, 24}) pixels.push_back(static_cast<std::uint8_t>(mixed >> shift));
  }
  image.samples = pixels;
  Scene scene = patchwork();
  scene.images.push_back(std::make_shared<const Image>(image));
  scene.textures.push_back({.image = 0});
  scene.materials[1] = {.base_color_texture = TextureUse{.texture = 0},
                        .alpha_mode = AlphaMode::mask};
  const Film one = drawn(scene, PerspectiveCamera{}, {.threads = 1});
  const Film many = drawn(scene, PerspectiveCamera{}, {.threads = 1, .samples = 16});
  const auto& instances = ids(one, "instance");
  for (const std::uint32_t id : {0U, 1U, 2U}) EXPECT_GT(std::ranges::count(instances, id), 20);
  for (std::size_t c = 0; c < one.channels.size(); ++c)
    EXPECT_EQ(one.channels[c].values, many.channels[c].values) << one.channels[c].name;
  EXPECT_NE(one.row(11)[18], many.row(11)[18]);
}

TEST(AovIntegrator, DrawsTheSameNumbers) {
  Scene scene = patchwork();
  scene.background = {0.5F, 0.5F, 0.5F};  // must not appear in an AOV picture
  const Film film = drawn(scene, PerspectiveCamera{});
  for (const Aov aov : kAovs) {
    if (aov == Aov::id) continue;
    SCOPED_TRACE(name_of(aov));
    const AovIntegrator integrator(aov);
    const Film picture = render(scene, PerspectiveCamera{}, kAovSize, {.integrator = &integrator});
    const std::string prefix = std::string(name_of(aov)) + ".";
    int component = 0;
    for (const Channel& c : film.channels) {
      if (!c.name.starts_with(prefix)) continue;
      const auto& values = std::get<std::vector<float>>(c.values);
      for (std::uint32_t y = 0; y < kAovSize.height; ++y) {
        for (std::uint32_t x = 0; x < kAovSize.width; ++x)
          EXPECT_EQ(picture.row(y)[x][component], values[std::size_t{y} * kAovSize.width + x]);
      }
      ++component;
    }
  }
}

/// The display value of a number before it is rounded to 8 bits.
float shown(const Display& display, float value) {
  return display.scale.x * value + display.offset.x;
}

TEST(AovIntegrator, ShowsNumbersInEightBits) {
  const Scene scene = scene_of({Disc{{-2, 0, -4}, {0, 0, 1}, 2}, Disc{{3, 0, -9}, {0, 0, 1}, 2}});
  const auto display = [&](Aov aov) {
    const AovIntegrator integrator(aov);
    return render(scene, PerspectiveCamera{.vertical_fov = 1.5}, kAovSize,
                  {.integrator = &integrator})
        .display;
  };
  EXPECT_NEAR(shown(display(Aov::depth), 4), 1, 1e-6);
  EXPECT_NEAR(shown(display(Aov::depth), 9), 0.2, 1e-6);
  EXPECT_EQ(shown(display(Aov::depth), kAovInfinity), -kAovInfinity);
  EXPECT_EQ(shown(display(Aov::normal), -1), 0);
  EXPECT_EQ(shown(display(Aov::normal), 1), 1);
  EXPECT_EQ(shown(display(Aov::uv), 0.25F), 0.25F);
  EXPECT_TRUE(display(Aov::albedo).srgb);
  for (const Aov aov : {Aov::depth, Aov::normal, Aov::position, Aov::id, Aov::uv, Aov::barycentric})
    EXPECT_FALSE(display(aov).srgb);
  const Display position = display(Aov::position);
  EXPECT_NEAR(position.scale.z * -9 + position.offset.z, 0, 1e-6);
  EXPECT_NEAR(position.scale.z * -4 + position.offset.z, 1, 1e-6);
}

TEST(AovIntegrator, AsksForOneSample) {
  const AovIntegrator integrator(Aov::depth);
  const std::vector<RenderOptions> bad = {{.integrator = &integrator, .samples = 2},
                                          {.aovs = {Aov::depth, Aov::uv, Aov::depth}}};
  for (const RenderOptions& options : bad) {
    try {
      (void)render(Scene{}, PerspectiveCamera{}, kAovSize, options);
      ADD_FAILURE();
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::usage);
    }
  }
}

}  // namespace
}  // namespace microtrace
