#include "render/film/camera_rays.hpp"
#include "render/prepared/content.hpp"

#include <microtrace/error.hpp>
#include <microtrace/integrator.hpp>
#include <microtrace/render_aovs.hpp>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <type_traits>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace microtrace {
namespace {

constexpr ImageSize kAovsSize{.width = 43, .height = 27};
constexpr std::uint32_t kGuard = 0xDEADBEEF;

/// Returns a bumpy square of n x n x 2 triangles that faces +z, with normals and texture
/// coordinates.
Mesh bumpy_square(const Vec3& center, float half, std::uint32_t n) {
  Mesh mesh;
  mesh.uv_sets.emplace_back();
  for (std::uint32_t i = 0; i <= n; ++i) {
    for (std::uint32_t j = 0; j <= n; ++j) {
      const float u = static_cast<float>(i) / static_cast<float>(n);
      const float v = static_cast<float>(j) / static_cast<float>(n);
      const float bump = 0.1F * half * static_cast<float>((i * 7 + j * 3) % 5);
      mesh.positions.push_back(center + Vec3((2 * u - 1) * half, (1 - 2 * v) * half, bump));
      mesh.normals.push_back(Vec3(glm::normalize(DVec3(u - 0.5, v - 0.5, 1))));
      mesh.uv_sets[0].push_back({u, v});
      if (i == n || j == n) continue;
      const std::uint32_t a = i * (n + 1) + j, b = a + n + 1;
      mesh.triangles.push_back({a, a + 1, b + 1});
      mesh.triangles.push_back({a, b + 1, b});
    }
  }
  return mesh;
}

std::shared_ptr<const Image> noisy_image() {
  Image image{.width = 32, .height = 32, .channels = 4};
  std::vector<std::uint8_t> bytes;
  for (std::uint32_t i = 0; i < 32 * 32; ++i) {
    const std::uint32_t mixed = i * 2654435761U;
    for (const int shift : {8, 16, 20, 24})
      bytes.push_back(static_cast<std::uint8_t>(mixed >> shift));
  }
  image.samples = bytes;
  return std::make_shared<const Image>(image);
}

/// Returns a scene with all kinds of shapes, and with every material property that affects
/// visibility.
Scene everything() {
  Scene scene;
  scene.images.push_back(noisy_image());
  scene.textures.push_back({.image = 0});
  const TextureUse texture{.texture = 0};
  scene.materials = {{.double_sided = true},
                     {.base_color = {0.5F, 0.25F, 1, 1}},
                     {.base_color_texture = texture, .alpha_mode = AlphaMode::mask},
                     {.base_color_texture = texture, .double_sided = true},
                     {.base_color = {1, 0, 0, 0.25F}, .alpha_mode = AlphaMode::blend}};
  const auto add = [&](Shape shape, std::optional<std::uint32_t> material = {}) {
    scene.objects.push_back({.name = std::to_string(scene.objects.size()),
                             .shape = std::move(shape),
                             .material = material});
  };
  add(bumpy_square({-0.5F, 0.25F, -2}, 0.5F, 6), 2);
  add(Mesh{.positions = {}, .triangles = {}});
  Mesh back = bumpy_square({0.75F, 0.5F, -2}, 0.4F, 3);
  for (auto& triangle : back.triangles.edit()) std::swap(triangle[0], triangle[1]);
  add(back, 1);  // culled
  add(back, 0);  // the same triangles, double-sided and seen from behind
  add(bumpy_square({0, 0, -5}, 4, 9), 3);
  add(bumpy_square({1.5F, -1, -4}, 1, 4), 1);
  add(Sphere{{-1, -1, -4}, 0.5F}, 1);
  add(Sphere{{0.25F, -0.75F, -2.5F}, 0.25F}, 4);
  add(Quadric{.a = 1, .b = 4, .c = 1, .h = 3, .i = 6, .j = 10.5F}, 0);
  add(Disc{{-1.25F, 1, -3}, {1, 2, -3}, 0.5F}, 0);
  add(Disc{{-1.25F, -0.25F, -3}, {1, 2, -3}, 0.5F}, 1);  // culled
  add(Triangle{{0.5F, -1, -1.5F}, {1, -1, -1.5F}, {0.75F, -0.5F, -1.5F}});
  add(Triangle{{0, 0, -1}, {0.25F, 0.25F, -1}, {0.5F, 0.5F, -1}}, 0);  // degenerate: a segment
  Mesh edge_on{.positions = {{0, 0, -1}, {0, 0, -2}, {0, 0.5F, -2}, {0, 0, -1}},
               .triangles = {{0, 1, 2}, {0, 0, 0}, {0, 3, 2}}};
  edge_on.normals = {{0, 0, 1}, {0, 0, 0}, {0, 0, -1}, {0, 1, 0}};
  add(edge_on, 0);
  add(Plane{{0, -2, 0}, {0, 1, 0}}, 1);
  return scene;
}

Scene with_lines() {
  Scene scene = everything();
  scene.objects.push_back(
      {.name = "lines",
       .shape = Mesh{.positions = {{-1, -1, -1.5F}, {1, 0.75F, -1.5F}, {0.5F, 0, -1}},
                     .triangles = {},
                     .segments = {{0, 1}, {2, 2}}}});
  return scene;
}

Scene far_away() {
  Scene scene = everything();
  scene.origin = {1e6, -2e5 + 0.1, 12345.678};
  return scene;
}

/// Returns a scene with a single, culled wall.
Scene all_culled() {
  Scene scene;
  scene.materials.push_back({});
  Mesh mesh = bumpy_square({0, 0, -2}, 6, 5);
  for (auto& triangle : mesh.triangles.edit()) std::swap(triangle[0], triangle[1]);
  scene.objects.push_back({.name = "wall", .shape = mesh, .material = 0});
  return scene;
}

std::vector<Camera> cameras() {
  const Pose turned{.position = {0.1, 0.2, 0.3}, .direction = {0.1, -0.05, -1}, .up = {0.1, 1, 0}};
  return {PerspectiveCamera{},
          PerspectiveCamera{.pose = turned, .depth = {.near = 1.5, .far = 4.5}},
          OrthographicCamera{.pose = {.position = {0, 0, 0.5}}, .height = 3},
          EnvironmentCamera{.pose = turned},
          CalibratedCamera{.pose = turned,
                           .image = {.width = 64, .height = 48},
                           .fx = 20,
                           .fy = 22,
                           .cx = 30,
                           .cy = 25,
                           .distortion = RationalDistortion{.k1 = -0.3}}};
}

/// Computes AOVs ray by ray, as the bits of floats or integers.
class Reference {
 public:
  Reference(const PreparedScene& scene, const Camera& camera)
      : content_(&scene.content(), [](const auto*) {}), camera_(camera, kAovsSize) {
    if (std::ranges::any_of(scene.scene().objects, [](const Object& object) {
          const auto* mesh = std::get_if<Mesh>(&object.shape);
          return mesh != nullptr && !mesh->segments.empty();
        }))
      content_ = scene.content().widened(camera, kAovsSize);
  }

  [[nodiscard]] std::vector<float> at(std::uint32_t x, std::uint32_t y, Aov aov) const {
    const World world{.scene = content_->scene(),
                      .bvh = content_->bvh(),
                      .camera = camera_,
                      .surfaces = content_->surfaces()};
    const Ray ray = CameraRays(camera_, world.scene)(x + 0.5, y + 0.5);
    const auto hit = world.first_visible(ray, world.bvh.intersect(ray));
    const auto vector = [](const auto& v) {
      std::vector<float> result;
      for (glm::length_t i = 0; i < v.length(); ++i) result.push_back(static_cast<float>(v[i]));
      return result;
    };
    if (!hit) {
      if (aov == Aov::depth || aov == Aov::distance)
        return {std::numeric_limits<float>::infinity()};
      return std::vector<float>(channels_of(aov).size());
    }
    const SurfaceInteraction s = world.surface(ray, *hit);
    const DVec3 way = s.p - DVec3(ray.o);
    switch (aov) {
      case Aov::depth:
        return {static_cast<float>(camera_.depth(s.p))};
      case Aov::distance:
        return {static_cast<float>(std::sqrt(glm::dot(way, way)))};
      case Aov::position:
        return vector(s.p + world.scene.origin);
      case Aov::normal:
        return vector(s.front ? s.ns : -s.ns);
      case Aov::face_normal:
        return vector(s.front ? s.n : -s.n);
      case Aov::uv:
        return vector(s.uv(0).value_or(DVec2(0)));
      case Aov::barycentric:
        return vector(s.triangle ? s.triangle->barycentrics : DVec3(0));
      case Aov::albedo:
        return vector(Vec3(world.base_color(ray, *hit)));
      case Aov::id:
        break;
    }
    const auto material = world.scene.objects[s.object].material;
    std::vector<float> ids;
    for (const std::size_t id :
         {s.object + 1, std::size_t{s.primitive} + 1, std::size_t{material ? *material + 1 : 0}})
      ids.push_back(std::bit_cast<float>(static_cast<std::uint32_t>(id)));
    return ids;
  }

 private:
  std::shared_ptr<const PreparedScene::Content> content_;
  RayGenerator camera_;
};

/// A buffer for an AOV with these strides. Guard values fill the gaps and both ends.
class Memory {
 public:
  Memory(Aov aov, ImageSize size, std::ptrdiff_t row, std::ptrdiff_t pixel, std::ptrdiff_t channel)
      : aov_(aov), size_(size), row_(row), pixel_(pixel), channel_(channel) {
    const auto span = [&](std::ptrdiff_t stride, std::size_t count, bool low) {
      return (stride < 0) == low ? stride * static_cast<std::ptrdiff_t>(count - 1) : 0;
    };
    std::ptrdiff_t low = 0, high = 0;
    for (const bool is_low : {true, false}) {
      (is_low ? low : high) = span(row, size.height, is_low) + span(pixel, size.width, is_low) +
                              span(channel, channels_of(aov).size(), is_low);
    }
    bits_.assign(static_cast<std::size_t>(high - low + 1 + 2 * kMargin), kGuard);
    first_ = kMargin - low;
  }

  [[nodiscard]] AovBuffer buffer(std::optional<std::size_t> channel = {}) {
    AovBuffer result{.aov = aov_,
                     .row_stride = row_,
                     .pixel_stride = pixel_,
                     .channel_stride = channel_,
                     .channel = channel};
    if (aov_ == Aov::id)
      result.data = bits_.data() + first_;
    else
      result.data = reinterpret_cast<float*>(bits_.data() + first_);
    return result;
  }

  /// Returns the value and replaces it by a guard. After all values are taken, only guards may
  /// remain.
  [[nodiscard]] std::uint32_t take(std::uint32_t x, std::uint32_t y, std::size_t channel) {
    return std::exchange(
        bits_[static_cast<std::size_t>(first_ + static_cast<std::ptrdiff_t>(y) * row_ +
                                       static_cast<std::ptrdiff_t>(x) * pixel_ +
                                       static_cast<std::ptrdiff_t>(channel) * channel_)],
        kGuard);
  }
  [[nodiscard]] bool has_only_guards() const {
    return std::ranges::all_of(bits_, [](std::uint32_t bits) { return bits == kGuard; });
  }

 private:
  static constexpr std::ptrdiff_t kMargin = 7;
  Aov aov_;
  ImageSize size_;
  std::ptrdiff_t row_, pixel_, channel_;
  std::ptrdiff_t first_ = 0;
  std::vector<std::uint32_t> bits_;
};

struct SceneCase {
  const char* name;
  Scene (*make)();
};
class RenderAovs : public testing::TestWithParam<SceneCase> {};
INSTANTIATE_TEST_SUITE_P(Scenes, RenderAovs,
                         testing::Values(SceneCase{"everything", everything},
                                         SceneCase{"with_lines", with_lines},
                                         SceneCase{"far_away", far_away},
                                         SceneCase{"all_culled", all_culled},
                                         SceneCase{"empty", [] { return Scene{}; }}),
                         [](const auto& scene) { return scene.param.name; });

TEST_P(RenderAovs, AreThoseOfSingleRays) {
  const PreparedScene scene(GetParam().make(), {.threads = 1});
  for (const Camera& camera : cameras()) {
    SCOPED_TRACE(camera.index());
    const Reference reference(scene, camera);
    std::vector<Memory> memories;
    std::vector<AovBuffer> buffers;
    memories.reserve(kAovs.size());
    for (const Aov aov : kAovs) {
      const auto channels = static_cast<std::ptrdiff_t>(channels_of(aov).size());
      memories.emplace_back(aov, kAovsSize, kAovsSize.width * channels, channels, 1);
      buffers.push_back(memories.back().buffer());
    }
    render_aovs(scene, camera, kAovsSize, buffers, {.threads = 1});
    for (std::size_t k = 0; k < kAovs.size(); ++k) {
      for (std::uint32_t y = 0; y < kAovsSize.height; ++y) {
        for (std::uint32_t x = 0; x < kAovsSize.width; ++x) {
          const std::vector<float> expected = reference.at(x, y, kAovs[k]);
          for (std::size_t c = 0; c < channels_of(kAovs[k]).size(); ++c)
            ASSERT_EQ(memories[k].take(x, y, c), std::bit_cast<std::uint32_t>(expected[c]))
                << name_of(kAovs[k]) << " " << c << " of pixel " << x << ", " << y;
        }
      }
      EXPECT_TRUE(memories[k].has_only_guards()) << name_of(kAovs[k]);
    }
  }
}

TEST_P(RenderAovs, AreChannelsOfTheFilm) {
  const PreparedScene scene(GetParam().make(), {.threads = 1});
  const PixelRect crop{.x0 = 3, .y0 = 5, .x1 = 42, .y1 = 18};
  for (const Camera& camera : cameras()) {
    for (const Aov aov : kAovs) {
      SCOPED_TRACE(name_of(aov));
      const Film film =
          render(scene, camera, kAovsSize, {.threads = 2, .crop = crop, .aovs = {aov}});
      const auto count = static_cast<std::ptrdiff_t>(channels_of(aov).size());
      const std::ptrdiff_t width = crop.size().width, height = crop.size().height;
      struct Strides {
        std::ptrdiff_t row, pixel, channel;
      };
      for (const Strides& s :
           {Strides{width * count, count, 1}, Strides{width, 1, width * height},
            Strides{-width * count, -count, -1}, Strides{-(width + 5), 1, 2 * width * height},
            Strides{1, height, -width * height}, Strides{4 * width, 4, 1}}) {
        Memory memory(aov, crop.size(), s.row, s.pixel, s.channel);
        const std::array buffers{memory.buffer()};
        render_aovs(scene, camera, kAovsSize, buffers, {.threads = 2, .crop = crop});
        for (std::size_t c = 0; c < film.channels.size(); ++c) {
          std::visit(
              [&](const auto& values) {
                for (std::uint32_t y = 0; y < crop.size().height; ++y) {
                  for (std::uint32_t x = 0; x < crop.size().width; ++x)
                    ASSERT_EQ(memory.take(x, y, c),
                              std::bit_cast<std::uint32_t>(
                                  values[std::size_t{y} * crop.size().width + x]));
                }
              },
              film.channels[c].values);
        }
        EXPECT_TRUE(memory.has_only_guards());
      }
    }
  }
}

TEST(RenderAovs, StoreSingleChannels) {
  const PreparedScene scene(everything(), {.threads = 1});
  for (const Aov aov : kAovs) {
    const auto count = static_cast<std::ptrdiff_t>(channels_of(aov).size());
    Memory all(aov, kAovsSize, kAovsSize.width * count, count, 1);
    std::vector<Memory> singles;
    std::vector<AovBuffer> buffers{all.buffer()};
    singles.reserve(3);
    for (std::size_t c = 0; c < channels_of(aov).size(); ++c) {
      singles.emplace_back(aov, kAovsSize, 2 * kAovsSize.width, 2, 0);
      buffers.push_back(singles.back().buffer(c));
    }
    render_aovs(scene, PerspectiveCamera{}, kAovsSize, buffers, {.threads = 1});
    for (std::uint32_t y = 0; y < kAovsSize.height; ++y) {
      for (std::uint32_t x = 0; x < kAovsSize.width; ++x) {
        for (std::size_t c = 0; c < singles.size(); ++c)
          ASSERT_EQ(singles[c].take(x, y, 0), all.take(x, y, c)) << name_of(aov) << " " << c;
      }
    }
    for (const Memory& single : singles) EXPECT_TRUE(single.has_only_guards());
  }
}

TEST(RenderAovs, IgnoreOtherOptions) {
  const PreparedScene scene(everything(), {.threads = 1});
  Memory one(Aov::depth, kAovsSize, kAovsSize.width, 1, 1), other = one;
  const FlatIntegrator flat;
  render_aovs(scene, PerspectiveCamera{}, kAovsSize, std::array{one.buffer()}, {.threads = 1});
  render_aovs(
      scene, PerspectiveCamera{}, kAovsSize, std::array{other.buffer()},
      {.threads = 3, .integrator = &flat, .samples = 16, .aovs = {Aov::id}, .transparent = true});
  for (std::uint32_t y = 0; y < kAovsSize.height; ++y) {
    for (std::uint32_t x = 0; x < kAovsSize.width; ++x)
      ASSERT_EQ(one.take(x, y, 0), other.take(x, y, 0));
  }
}

void expect_refused(const AovBuffer& buffer, const RenderOptions& options, const char* message) {
  const PreparedScene scene(Scene{}, {.threads = 1});
  try {
    render_aovs(scene, PerspectiveCamera{}, kAovsSize, std::array{buffer}, options);
    ADD_FAILURE() << "no error: " << message;
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::usage);
    EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
  }
}

TEST(RenderAovs, RefuseWrongBuffers) {
  std::vector<float> floats(kAovsSize.width * kAovsSize.height);
  std::vector<std::uint32_t> integers(floats.size());
  expect_refused({.aov = Aov::depth}, {}, "depth is a null pointer");
  expect_refused({.aov = Aov::id, .data = floats.data()}, {}, "id needs std::uint32_t");
  expect_refused({.aov = Aov::uv, .data = integers.data()}, {}, "uv needs float");
  expect_refused({.aov = Aov::uv, .data = floats.data(), .channel = 2}, {}, "channel 2 of 0 to 1");
  expect_refused({.aov = Aov::depth, .data = floats.data()},
                 {.crop = PixelRect{.x0 = 0, .y0 = 0, .x1 = 44, .y1 = 1}}, "crop");
}

TEST(RenderAovs, ReportAndCancel) {
  const PreparedScene scene(everything(), {.threads = 1});
  std::vector<float> depths(kAovsSize.width * kAovsSize.height);
  const AovBuffer buffer{.aov = Aov::depth, .data = depths.data(), .row_stride = kAovsSize.width};
  RenderCounts counts;
  RenderTimes times{.build = -1, .trace = -1};
  double done = 0;
  render_aovs(scene, PerspectiveCamera{}, kAovsSize, std::array{buffer},
              {.threads = 2,
               .progress =
                   [&](double fraction) {
                     EXPECT_GE(fraction, done);
                     done = fraction;
                     return true;
                   },
               .times = &times,
               .counts = &counts});
  EXPECT_EQ(done, 1);
  EXPECT_EQ(counts.samples, depths.size());
  EXPECT_EQ(counts.samples_per_pixel, 1U);
  EXPECT_GE(times.build, 0);
  EXPECT_GE(times.trace, 0);
  try {
    render_aovs(scene, PerspectiveCamera{}, kAovsSize, std::array{buffer},
                {.threads = 2, .progress = [](double) { return false; }});
    ADD_FAILURE() << "not canceled";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::canceled);
  }
}

TEST(RenderAovs, RunOnThreadsOfTheHost) {
  const PreparedScene scene(everything(), {.threads = 1});
  Memory own(Aov::normal, kAovsSize, 3 * kAovsSize.width, 3, 1), host = own;
  render_aovs(scene, PerspectiveCamera{}, kAovsSize, std::array{own.buffer()}, {.threads = 1});
  std::atomic<int> calls = 0;
  render_aovs(scene, PerspectiveCamera{}, kAovsSize, std::array{host.buffer()},
              {.threads = 3, .run_threads = [&](unsigned count, const std::function<void()>& work) {
                 std::vector<std::jthread> threads;
                 for (unsigned i = 0; i < count; ++i)
                   threads.emplace_back([&] { ++calls, work(); });
               }});
  EXPECT_EQ(calls, 3);
  for (std::uint32_t y = 0; y < kAovsSize.height; ++y) {
    for (std::uint32_t x = 0; x < kAovsSize.width; ++x) {
      for (std::size_t c = 0; c < 3; ++c) ASSERT_EQ(own.take(x, y, c), host.take(x, y, c));
    }
  }
}

}  // namespace
}  // namespace microtrace
