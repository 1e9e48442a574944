// Measures whole pictures without file output: rays per second for a scene's first camera, by
// number of threads.

#include <microtrace/io.hpp>
#include <microtrace/render.hpp>

#include <filesystem>

#include <benchmark/benchmark.h>

namespace {

using namespace microtrace;

void picture(benchmark::State& state, const char* name) {
  const Scene scene =
      load_scene(std::filesystem::path(MICROTRACE_SOURCE_DIR "/scenes") / name).scene;
  const RenderOptions options{.threads = static_cast<unsigned>(state.range(0))};
  for (auto _ : state)
    benchmark::DoNotOptimize(render(scene, scene.cameras[0].camera, scene.size, options));
  state.counters["pixels/s"] = benchmark::Counter(double{1} * scene.size.width * scene.size.height,
                                                  benchmark::Counter::kIsIterationInvariantRate);
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
BENCHMARK_CAPTURE(encode, binary, PpmEncoding::binary);
BENCHMARK_CAPTURE(encode, ascii, PpmEncoding::ascii);
