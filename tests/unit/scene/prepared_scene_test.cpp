// Checks that a prepared scene gives the same pictures and query results as the scene itself.

#include "base/memory_account.hpp"
#include "render/prepared/content.hpp"
#include "support/cases/generated_meshes.hpp"
#include "support/pictures.hpp"

#include <microtrace/error.hpp>
#include <microtrace/framing.hpp>
#include <microtrace/io.hpp>
#include <microtrace/path.hpp>
#include <microtrace/prepared_scene.hpp>
#include <microtrace/render.hpp>
#include <microtrace/validate.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

namespace microtrace {
namespace {

using ::testing::HasSubstr;

constexpr ImageSize kPreparedSize{.width = 24, .height = 18};

std::shared_ptr<const Image> checkers() {
  auto image = std::make_shared<Image>();
  *image = {.name = "", .width = 8, .height = 8, .channels = 1, .samples = {}};
  std::vector<std::uint8_t> pixels;
  for (std::uint32_t i = 0; i < 64; ++i) pixels.push_back((i / 8 + i) % 2 == 0 ? 40 : 230);
  image->samples = pixels;
  return image;
}

/// Returns a textured terrain, an emitter and a point light, all translated by `shift`.
Scene furnished(const Vec3& shift = Vec3(0)) {
  Scene scene;
  Mesh mesh = generated::terrain(400);
  mesh.uv_sets.emplace_back();
  for (Vec3& p : mesh.positions.edit()) {
    mesh.uv_sets[0].push_back({p.x * 3, p.z * 3});
    p = Vec3(std::round(p.x * 64), std::round(p.y * 64), std::round(p.z * 64)) / 64.0F + shift;
  }
  scene.images = {checkers()};
  scene.textures = {{.image = 0}};
  scene.materials = {{.base_color_texture = TextureUse{}, .double_sided = true},
                     {.emissive = Vec3(5)}};
  scene.objects.push_back({.name = "ground", .shape = std::move(mesh), .material = 0});
  scene.objects.push_back(
      {.name = "lamp", .shape = Sphere{Vec3(0, 1, 0) + shift, 0.25F}, .material = 1});
  scene.lights.push_back(
      {.name = "", .light = PointLight{.position = DVec3(shift) + DVec3(0.5, 1, 0.25)}});
  return scene;
}

std::vector<Camera> views_of(const Scene& scene) {
  std::vector<Camera> views;
  for (const double azimuth : {0.0, 75.0, 200.0})
    views.emplace_back(frame(scene, {.azimuth = azimuth}, kPreparedSize));
  return views;
}

void expect_same(const Film& a, const Film& b) {
  ASSERT_EQ(pixels_of(a), pixels_of(b));
  ASSERT_EQ(a.channels.size(), b.channels.size());
  for (std::size_t i = 0; i < a.channels.size(); ++i) {
    EXPECT_EQ(a.channels[i].name, b.channels[i].name);
    EXPECT_EQ(a.channels[i].values, b.channels[i].values);
  }
}

RenderOptions lit(const PathIntegrator& path) {
  RenderOptions options{.threads = 1, .integrator = &path, .samples = 2};
  options.aovs = {Aov::id, Aov::position};
  options.sampled_aovs = {SampledAov::denoise_albedo};
  return options;
}

TEST(PreparedScene, DrawsTheSamePictures) {
  const PathIntegrator path({.max_depth = 4});
  // Path tracing translates the scene to the origin for the last two shifts, by a translation that
  // depends on the camera.
  for (const Vec3& shift : {Vec3(0), Vec3(4096, 0, -8192), Vec3(1e6F, 0, 0)}) {
    const Scene scene = furnished(shift);
    const PreparedScene prepared(scene);
    for (const Camera& camera : views_of(scene)) {
      expect_same(render(prepared, camera, kPreparedSize), render(scene, camera, kPreparedSize));
      expect_same(render(prepared, camera, kPreparedSize, lit(path)),
                  render(scene, camera, kPreparedSize, lit(path)));
    }
  }
}

TEST(PreparedScene, PreparesOnce) {
  MemoryBudget budget(std::uint64_t{1} << 30U);
  const Scene scene = furnished({4096, 0, 0});
  const PathIntegrator path;
  {
    const PreparedScene prepared(scene, {.memory = &budget});
    const Camera camera = views_of(scene)[0];
    (void)render(prepared, camera, kPreparedSize, lit(path));
    const auto& content = prepared.content();
    const Shading* shading = &content.shading();
    const Emitters* emitters = &content.emitters();
    const auto moved = content.recentered(camera);
    ASSERT_TRUE(moved);
    const std::uint64_t after_one = budget.peak();
    EXPECT_GT(after_one, 0U);
    for (int i = 0; i < 3; ++i) (void)render(prepared, camera, kPreparedSize, lit(path));
    EXPECT_EQ(budget.peak(), after_one);
    EXPECT_EQ(shading, &content.shading());
    EXPECT_EQ(emitters, &content.emitters());
    EXPECT_EQ(moved->content, content.recentered(camera)->content);
  }
  EXPECT_NO_THROW(budget.take(budget.limit(), "all")) << "a prepared scene gives all back";
}

TEST(PreparedScene, SharesTablesWithTheNextFrame) {
  Scene scene = furnished();
  auto map = std::make_shared<RadianceMap>();
  *map = {.width = 16, .height = 8, .pixels = std::vector<Vec3>(128, Vec3(0.5F))};
  map->pixels[20] = Vec3(30);
  scene.environment = Environment{.content = std::shared_ptr<const RadianceMap>(map)};
  const Camera camera = views_of(scene)[1];
  const PathIntegrator path({.max_depth = 3});
  const PreparedScene first(scene);
  (void)render(first, camera, kPreparedSize, lit(path));
  const auto tables = first.content().tables()->of(*scene.environment);

  std::get<Sphere>(scene.objects[1].shape).center.y = 2;  // the next pose of the scene
  const PreparedScene second(scene, {.tables = first.tables()});
  EXPECT_EQ(second.content().tables()->of(*scene.environment), tables);
  expect_same(render(second, camera, kPreparedSize, lit(path)),
              render(scene, camera, kPreparedSize, lit(path)));
}

TEST(PreparedScene, DrawsPosesLikeNewScenes) {
  Scene scene = furnished();
  const Camera camera = views_of(scene)[1];
  const PathIntegrator path({.max_depth = 3});
  std::shared_ptr<const SharedTables> tables;
  for (int pose = 0; pose < 5; ++pose) {
    const PreparedScene prepared(
        scene,
        {.threads = pose % 2 == 0 ? 1U : 7U, .tables = std::move(tables), .max_cost_growth = 1e9});
    tables = prepared.tables();
    expect_same(render(prepared, camera, kPreparedSize), render(scene, camera, kPreparedSize));
    expect_same(render(prepared, camera, kPreparedSize, lit(path)),
                render(scene, camera, kPreparedSize, lit(path)));
    for (Vec3& p : std::get<Mesh>(scene.objects[0].shape).positions.edit())
      p.y += 0.1F * p.x + 0.05F * p.z;
  }
}

TEST(PreparedScene, ReleasesTheLastPoseIfThereIsNoRoomForBoth) {
  Scene scene;
  scene.objects.push_back({.name = "", .shape = generated::terrain(5000)});
  MemoryBudget generous(std::uint64_t{1} << 30U);
  (void)PreparedScene(scene, {.memory = &generous});
  MemoryBudget tight(generous.peak());
  {
    std::shared_ptr<const SharedTables> tables;
    for (int pose = 0; pose < 3; ++pose)
      tables = PreparedScene(scene, {.memory = &tight, .tables = std::move(tables)}).tables();
  }
  EXPECT_NO_THROW(tight.take(tight.limit(), "all")) << "trees without scenes give all back";
}

// A picture that fails for lack of memory must not change those that follow.
TEST(PreparedScene, TranslatesADistantSceneAfterAFailure) {
  constexpr float kFar = 0x1p20F;
  Mesh mesh = generated::displaced_sphere(2000);
  for (Vec3& p : mesh.positions.edit()) p = 4.0F * p + Vec3(kFar);
  Scene scene;
  scene.objects.push_back({.name = "", .shape = mesh});
  PerspectiveCamera camera;
  camera.pose = {.position = DVec3(kFar) + DVec3(0, 0, 20), .direction = {0, 0, -1}};
  const PathIntegrator light;
  const auto draw = [&](const PreparedScene& prepared) {
    return encode_ppm(render(prepared, camera, {.width = 32, .height = 24},
                             {.integrator = &light, .samples = 4}));
  };
  const std::string expected = draw(PreparedScene(scene));
  MemoryBudget budget(64 << 20);
  const PreparedScene prepared(scene, {.memory = &budget});
  {
    MemoryAccount other(&budget);
    for (std::uint64_t size = 64 << 20; size >= 1024; size /= 2) {
      try {
        while (true) other.take(size, "something else");
      } catch (const Error&) {
      }
    }
    EXPECT_THROW(draw(prepared), Error);
  }
  EXPECT_EQ(draw(prepared), expected);
}

TEST(PreparedScene, TakesAnotherEnvironment) {
  Scene scene = furnished();
  const PreparedScene prepared(scene);
  const Camera camera = views_of(scene)[0];
  const PathIntegrator path({.max_depth = 3});
  for (const Environment& environment :
       {Environment{.content = Studio{}}, Environment{.content = Vec3(0.2F, 0.4F, 0.9F)},
        Environment{.content = Studio{}, .rotation = 1, .intensity = 3, .is_background = true}}) {
    RenderOptions options = lit(path);
    options.environment = environment;
    scene.environment = environment;
    expect_same(render(prepared, camera, kPreparedSize, options),
                render(scene, camera, kPreparedSize, lit(path)));
  }
}

// The pixels of a map are checked only once.
TEST(PreparedScene, ChecksEnvironmentsWhoseMapItKnows) {
  const Scene scene = furnished();
  const PreparedScene prepared(scene);
  const PathIntegrator path({.max_depth = 3});
  const auto map_of = [](float second) {
    return std::make_shared<const RadianceMap>(
        RadianceMap{.width = 2, .height = 1, .pixels = {Vec3(1), Vec3(second)}});
  };
  const auto draw = [&](const Environment& environment) {
    RenderOptions options = lit(path);
    options.environment = environment;
    return render(prepared, views_of(scene)[0], kPreparedSize, options);
  };
  const Environment valid{.content = map_of(2)};
  Environment turned = valid;
  turned.rotation = std::numeric_limits<double>::quiet_NaN();
  const Film first = draw(valid);
  EXPECT_THROW((void)draw(turned), Error);
  EXPECT_THROW((void)draw({.content = map_of(-1)}), Error);
  expect_same(draw(valid), first);
}

TEST(PreparedScene, MayBeSharedByThreads) {
  const Scene scene = furnished({4096, 0, 0});
  const PathIntegrator path({.max_depth = 3});
  const std::vector<Camera> views = views_of(scene);
  std::vector<Film> expected;
  for (const Camera& camera : views)
    expected.push_back(render(scene, camera, kPreparedSize, lit(path)));
  for (int round = 0; round < 5; ++round) {
    const PreparedScene prepared(scene);
    std::vector<std::optional<Film>> films(2 * views.size());
    {
      std::vector<std::jthread> threads;
      for (std::size_t i = 0; i < films.size(); ++i) {
        threads.emplace_back([&, i] {
          films[i] = render(prepared, views[i % views.size()], kPreparedSize, lit(path));
        });
      }
    }
    for (std::size_t i = 0; i < films.size(); ++i)
      expect_same(films[i].value(), expected[i % views.size()]);
  }
}

TEST(PreparedScene, QueriesAreInWorldSpace) {
  const DVec3 origin(1e7, -3e6, 0.5);
  Scene scene = furnished();
  scene.origin = origin;
  const PreparedScene prepared(scene);
  EXPECT_FALSE(prepared.intersect({.o = {0, 5, 0}, .d = {0, -1, 0}}));
  const Vec3 above(DVec3(0, 5, 0) + origin);
  const Ray ray{.o = above, .d = {0, -1, 0}};
  const std::optional<Hit> hit = prepared.intersect(ray);
  ASSERT_TRUE(hit);
  EXPECT_TRUE(prepared.occluded(ray));
  const SurfaceInteraction at = prepared.surface(ray, *hit);
  EXPECT_EQ(at.object, 1U) << "the lamp hangs over the ground";
  EXPECT_NEAR(at.p.x, double{above.x}, 1e-6);
  EXPECT_NEAR(at.p.y, origin.y + 1.25, 0.1);
  const std::optional<Hit> ground = prepared.next(ray, *hit);
  ASSERT_TRUE(ground);
  const SurfaceInteraction below = prepared.surface(ray, *ground);
  EXPECT_EQ(below.object, 0U);
  EXPECT_LT(below.primitive, std::get<Mesh>(scene.objects[0].shape).triangles.size());
  ASSERT_TRUE(below.uv(0));
  const std::array<Ray, 2> rays{ray, Ray{.o = above, .d = {0, 1, 0}}};
  std::array<std::optional<Hit>, 2> hits;
  prepared.intersect(rays, hits);
  EXPECT_EQ(hits[0]->id, hit->id);
  EXPECT_FALSE(hits[1]);
  std::array<bool, 2> occluded{};
  prepared.occluded(rays, occluded);
  EXPECT_TRUE(occluded[0]);
  EXPECT_FALSE(occluded[1]);
}

TEST(PreparedScene, OwnsItsScene) {
  std::optional<Scene> scene = furnished();
  const Camera camera = views_of(*scene)[0];
  const Film expected = render(*scene, camera, kPreparedSize);
  const PreparedScene copy = [&] {
    PreparedScene first(*std::move(scene));
    scene.reset();
    return PreparedScene(first);
  }();
  expect_same(render(copy, camera, kPreparedSize), expected);
  // Types that keep a reference to the scene must not accept temporaries.
  static_assert(!std::is_constructible_v<Bvh, Scene>);
  static_assert(!std::is_constructible_v<Primitives, Scene>);
  static_assert(std::is_constructible_v<Bvh, const Scene&>);
}

/// Checks that both functions reject the scene with an error at this pointer.
void expect_refused(const Scene& scene, const char* pointer) {
  const auto expect = [&](const auto& f) {
    try {
      f();
      FAIL() << "not refused: " << pointer;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::invalid_scene);
      EXPECT_EQ(error.diagnostic().pointer, pointer);
      EXPECT_THAT(error.what(), HasSubstr(pointer));
    }
  };
  expect([&] { validate(scene); });
  expect([&] { (void)PreparedScene(scene); });
  expect([&] { (void)render(scene, PerspectiveCamera{}, kPreparedSize); });
}

TEST(Validate, RefusesIndicesOutOfRange) {
  const Scene good = furnished();
  EXPECT_NO_THROW(validate(good));
  const auto with = [&](const auto& change) {
    Scene scene = good;
    change(scene);
    return scene;
  };
  const auto mesh = [](Scene& s) -> Mesh& { return std::get<Mesh>(s.objects[0].shape); };
  expect_refused(with([&](Scene& s) {
                   mesh(s).triangles.edit()[7][1] =
                       static_cast<std::uint32_t>(mesh(s).positions.size());
                 }),
                 "/objects/0/shape/triangles");
  expect_refused(with([&](Scene& s) {
                   mesh(s).segments = {{0, ~0U}};
                 }),
                 "/objects/0/shape/segments");
  expect_refused(with([&](Scene& s) { mesh(s).uv_sets[0].resize(3); }), "/objects/0/shape/uv_sets");
  expect_refused(with([&](Scene& s) { mesh(s).normals.resize(1); }), "/objects/0/shape/normals");
  expect_refused(with([&](Scene& s) { s.objects[1].material = 2; }), "/objects/1/material");
  expect_refused(with([&](Scene& s) { s.materials[0].base_color_texture->texture = 1; }),
                 "/materials/0/texture");
  expect_refused(with([&](Scene& s) { s.textures[0].image = 1; }), "/textures/0/image");
  expect_refused(with([&](Scene& s) {
                   auto image = std::make_shared<Image>(*s.images[0]);
                   image->height = 9;
                   s.images[0] = image;
                 }),
                 "/images/0/samples");
  expect_refused(with([&](Scene& s) {
                   s.environment =
                       Environment{.content = std::shared_ptr<const RadianceMap>(nullptr)};
                 }),
                 "/environment/content");
}

TEST(Validate, RefusesNumbersThatAreNotFinite) {
  Scene scene = furnished();
  std::get<Mesh>(scene.objects[0].shape).positions.edit()[3].y = std::nanf("");
  EXPECT_THROW(validate(scene), Error);
  // Rendering accepts the triangles that use this vertex, because it treats them as empty.
  EXPECT_NO_THROW((void)render(scene, views_of(scene)[0], kPreparedSize));
  scene = furnished();
  scene.cameras.push_back({.name = "", .camera = PerspectiveCamera{.vertical_fov = 4}});
  EXPECT_THROW(validate(scene), Error);
}

TEST(Validate, RefusesNumbersOfTheSceneOutOfRange) {
  const auto refused_at = [](const char* pointer, const auto& change) {
    Scene scene = furnished();
    change(scene);
    try {
      validate(scene);
      ADD_FAILURE() << "not refused: " << pointer;
    } catch (const Error& error) {
      EXPECT_EQ(error.diagnostic().pointer, pointer);
    }
  };
  const float infinity = std::numeric_limits<float>::infinity();
  refused_at("/origin", [](Scene& s) { s.origin.y = std::nan(""); });
  refused_at("/background", [&](Scene& s) { s.background.z = -infinity; });
  refused_at("/epsilon", [](Scene& s) { s.epsilon = -1; });
  refused_at("/epsilon", [&](Scene& s) { s.epsilon = infinity; });
  refused_at("/size/width", [](Scene& s) { s.size.width = 0; });
  refused_at("/size/height", [](Scene& s) { s.size.height = 65537; });
}

}  // namespace
}  // namespace microtrace
