// Measures the rendering of whole pictures without file output: pixels per second for a scene's
// first camera, for several numbers of threads, and for a program written by hand.

#include "exercise_by_hand.hpp"
#include "support/cases/generated_meshes.hpp"

#include <microtrace/framing.hpp>
#include <microtrace/io.hpp>
#include <microtrace/render.hpp>
#include <microtrace/render_aovs.hpp>

#include <array>
#include <cstdint>
#include <filesystem>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>
#include <glm/geometric.hpp>

namespace {

using namespace microtrace;

benchmark::Counter pixels(ImageSize size) {
  return {double{1} * size.width * size.height, benchmark::Counter::kIsIterationInvariantRate};
}

/// Renders a picture and encodes it as 8-bit PPM.
void picture(benchmark::State& state, const char* name) {
  const Scene scene =
      load_scene(std::filesystem::path(MICROTRACE_SOURCE_DIR "/scenes") / name).scene;
  const RenderOptions options{.threads = static_cast<unsigned>(state.range(0))};
  for (auto _ : state)
    benchmark::DoNotOptimize(encode_ppm(render(scene, scene.cameras[0].camera, scene.size, options),
                                        PpmEncoding::binary));
  state.counters["pixels/s"] = pixels(scene.size);
}

/// Does the same by the program that microtrace is compared with.
void by_hand_picture(benchmark::State& state, const by_hand::Camera& camera) {
  constexpr ImageSize kSize{.width = 640, .height = 480};
  for (auto _ : state) benchmark::DoNotOptimize(by_hand::render(camera, kSize.width, kSize.height));
  state.counters["pixels/s"] = pixels(kSize);
}
constexpr by_hand::Camera kFirst{{0, 0, 10}, {0, 0, -1}, {0, 1, 0}, 60};
constexpr by_hand::Camera kSecond{{-8, 3, 8}, {1, -0.1F, -1}, {0, 1, 0}, 45};
constexpr by_hand::Camera kThird{{-8, 3, 8}, {1, -0.1F, -1}, {1, 1, 0}, 45};

/// Renders depth, both normals and object ids of a view of 15 000 triangles on one thread, and
/// measures processor time.
void aovs(benchmark::State& state) {
  Mesh mesh = generated::displaced_sphere(15000);
  for (const Vec3& p : mesh.positions) mesh.normals.push_back(glm::normalize(p));
  Scene made;
  made.objects.push_back({.name = "sphere", .shape = std::move(mesh)});
  const PreparedScene scene(std::move(made), {.threads = 1});
  constexpr ImageSize size{.width = 640, .height = 480};
  constexpr std::ptrdiff_t width = size.width;
  std::vector<float> depth(640 * 480), normal(3 * depth.size()), face_normal(normal.size());
  std::vector<std::uint32_t> object(depth.size());
  const std::array buffers{
      AovBuffer{.aov = Aov::depth, .data = depth.data(), .row_stride = width},
      AovBuffer{
          .aov = Aov::normal, .data = normal.data(), .row_stride = 3 * width, .pixel_stride = 3},
      AovBuffer{.aov = Aov::face_normal,
                .data = face_normal.data(),
                .row_stride = 3 * width,
                .pixel_stride = 3},
      AovBuffer{.aov = Aov::id, .data = object.data(), .row_stride = width, .channel = 0}};
  double azimuth = 0;
  for (auto _ : state) {
    render_aovs(scene, frame(scene.scene(), {.azimuth = azimuth}, size), size, buffers,
                {.threads = 1});
    azimuth += 3.6;
    benchmark::ClobberMemory();
  }
}

void encode(benchmark::State& state, PpmEncoding encoding) {
  const Scene scene = load_scene(MICROTRACE_SOURCE_DIR "/scenes/perspective1.json").scene;
  const Film film = render(scene, scene.cameras[0].camera, scene.size);
  for (auto _ : state) benchmark::DoNotOptimize(encode_ppm(film, encoding));
}

}  // namespace

BENCHMARK_CAPTURE(picture, perspective1, "perspective1.json")->Arg(1)->Arg(2)->UseRealTime();
BENCHMARK_CAPTURE(picture, perspective2, "perspective2.json")->Arg(1)->Arg(2)->UseRealTime();
BENCHMARK_CAPTURE(picture, perspective3, "perspective3.json")->Arg(1)->Arg(2)->UseRealTime();
BENCHMARK_CAPTURE(by_hand_picture, perspective1, kFirst)->UseRealTime();
BENCHMARK_CAPTURE(by_hand_picture, perspective2, kSecond)->UseRealTime();
BENCHMARK_CAPTURE(by_hand_picture, perspective3, kThird)->UseRealTime();
BENCHMARK(aovs)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(encode, binary, PpmEncoding::binary);
BENCHMARK_CAPTURE(encode, ascii, PpmEncoding::ascii);
