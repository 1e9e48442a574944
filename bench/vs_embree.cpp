// Compares ray casting with Embree. The programs alternately trace the same rays through the same
// meshes. bench/README.md describes the comparison.

#include "accel/kernels/dispatch.hpp"
#include "arguments.hpp"
#include "vs_embree_report.hpp"

#include <cstdio>
#include <cstdlib>
#include <embree3/rtcore_config.h>
#include <exception>
#include <fstream>
#include <functional>
#include <stdexcept>

namespace {

using namespace microtrace;
using namespace microtrace::bench;

constexpr const char* kUsage =
    "usage: bench_vs_embree [--scenes sphere,hall,terrain,field] [--scaling] [--threads N] [--runs "
    "N]\n"
    "                       [--quick] [--output FILE.json] [MESH.glb ...]\n"
    "--scaling  the displaced sphere at 10^4 to 10^7 triangles instead of the scenes\n"
    "--runs     of each program, in turn; at least 1 (7)\n"
    "--quick    a ninth of the rays, a hundredth of the scenes' triangles, 3 runs\n";

struct Arguments {
  std::vector<std::string> scenes, files;
  std::string output = "bench_vs_embree.json";
  CompareOptions options;
  bool scaling = false, quick = false;
};

Arguments parse(std::span<char*> words) {
  Arguments arguments;
  bool runs_given = false;
  for (std::size_t i = 1; i < words.size(); ++i) {
    const std::string word = words[i];
    const auto value = [&] {
      if (++i == words.size()) throw std::invalid_argument(word + " needs a value");
      return std::string(words[i]);
    };
    if (word == "--scenes") {
      arguments.scenes = split_names(value());
    } else if (word == "--scaling") {
      arguments.scaling = true;
    } else if (word == "--threads") {
      arguments.options.threads = number(value());
    } else if (word == "--runs") {
      arguments.options.runs = number(value());
      runs_given = true;
    } else if (word == "--quick") {
      arguments.quick = true;
    } else if (word == "--output") {
      arguments.output = value();
    } else if (word.starts_with("-")) {
      throw std::invalid_argument("no option " + word);
    } else {
      arguments.files.push_back(word);
    }
  }
  if (arguments.quick) {
    arguments.options.size = {.width = 640, .height = 360};
    if (!runs_given) arguments.options.runs = 3;
  }
  if (arguments.scenes.empty() && arguments.files.empty() && !arguments.scaling)
    arguments.scenes = generated_scene_names();
  return arguments;
}

void run(const Arguments& arguments) {
  // Creates each scene only when it is measured, because large scenes need much memory.
  std::vector<std::function<BenchScene()>> scenes;
  if (arguments.scaling) {
    for (const unsigned triangles : {10'000U, 100'000U, 1'000'000U, 10'000'000U})
      scenes.emplace_back([=] { return sphere_scene(triangles); });
  }
  for (const std::string& name : arguments.scenes)
    scenes.emplace_back([&, name] { return generated_scene(name, arguments.quick); });
  for (const std::string& file : arguments.files)
    scenes.emplace_back([file] { return scene_from_file(file); });

  std::printf(
      "microtrace with %s kernels, Embree %s, threads: %u, runs: %u,\n"
      "%s seconds, denormal numbers kept (no flush to zero) for both\n\n%s",
      kRayKernels.best().name, RTC_VERSION_STRING, arguments.options.threads,
      arguments.options.runs, arguments.options.threads == 1 ? "processor" : "wall-clock",
      table_head().c_str());
  std::vector<SceneRows> all;
  for (const auto& make : scenes) {
    all.push_back(compare(make(), arguments.options));
    std::fputs(table_lines(all.back()).c_str(), stdout);
    std::fflush(stdout);
  }
  std::ofstream file(arguments.output);
  if (!(file << json(all)).flush()) throw std::runtime_error("can't write " + arguments.output);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    run(parse({argv, static_cast<std::size_t>(argc)}));
    return EXIT_SUCCESS;
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "bench_vs_embree: %s\n%s", error.what(), kUsage);
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_vs_embree: %s\n", error.what());
    return EXIT_FAILURE;
  }
}
