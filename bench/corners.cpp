// Compares scenes of axis-aligned walls that touch and share planes with copies of these scenes
// rotated by an arbitrary angle. Measures the time per query, and the number of queries that reach
// each stage after float32.

#include "arguments.hpp"
#include "rays.hpp"
#include "support/cases/architecture.hpp"
#include "timing.hpp"

#include <microtrace/bvh.hpp>
#include <microtrace/path.hpp>
#include <microtrace/render.hpp>
#include <microtrace/stage_counts.hpp>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

namespace {

using namespace microtrace;
using namespace microtrace::bench;
using generated::ArchitectureScene;

constexpr const char* kUsage =
    "usage: bench_corners [--scenes room,voxels,...] [--runs N] [--pictures SAMPLES]\n"
    "--scenes    of tests/support/cases/architecture.hpp; all\n"
    "--runs      of each scene and its turned twin, in turn; the fastest counts (5)\n"
    "--pictures  lit pictures of 320x240 pixels instead of rays\n";

constexpr ImageSize kSize{.width = 320, .height = 240};
constexpr std::size_t kBatch = 1024;  // the batch size of integrators
constexpr int kBounces = 4;

enum Kind : std::size_t { camera, origin, path, shadow, kKinds };
constexpr std::array<const char*, kKinds> kKindNames{"camera", "origin", "path", "shadow"};

struct Cost {
  std::size_t questions = 0;
  double seconds = 0;
  StageCounts stages;
};
using Costs = std::array<Cost, kKinds>;

/// Traces paths from one view, four bounces long, with a shadow ray at each hit.
class Tracer {
 public:
  Tracer(const Bvh& bvh, const DVec3& light) : bvh_(bvh), light_(light) {}

  Costs trace(const std::vector<Ray>& rays) {
    costs_ = {};
    for (std::size_t i = 0; i < rays.size(); i += kBatch)
      follow({rays.begin() + static_cast<std::ptrdiff_t>(i),
              rays.begin() + static_cast<std::ptrdiff_t>(std::min(i + kBatch, rays.size()))},
             i);
    return costs_;
  }

 private:
  template <class F>
  void measure(Kind kind, std::size_t questions, const F& ask) {
    Cost& cost = costs_[kind];
    const StageCounts before = stage_counts();
    cost.seconds += seconds(1, ask);
    const StageCounts after = stage_counts();
    cost.questions += questions;
    cost.stages += after - before;
  }

  void follow(std::vector<Ray> rays, std::uint64_t seed) {
    for (int bounce = 0; bounce <= kBounces && !rays.empty(); ++bounce) {
      std::vector<std::optional<Hit>> hits(rays.size());
      measure(bounce == 0 ? camera : path, rays.size(), [&] {
        const std::size_t step = bounce == 0 ? bench::kTileRays : rays.size();
        for (std::size_t i = 0; i < rays.size(); i += step)
          bvh_.intersect(std::span(rays).subspan(i, step), std::span(hits).subspan(i, step));
      });
      rays = scatter(rays, hits, seed + (static_cast<std::uint64_t>(bounce) << 32U));
    }
  }

  /// Casts a shadow ray from each hit, and returns the next rays of the paths.
  std::vector<Ray> scatter(const std::vector<Ray>& rays,
                           const std::vector<std::optional<Hit>>& hits, std::uint64_t seed) {
    std::vector<Bvh::Spawn> spawns;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (!hits[i]) continue;
      const Ray& ray = rays[i];
      const DVec3 p = DVec3(ray.o) + double{hits[i]->t} * DVec3(ray.d);
      const std::optional<DVec3> n = normal(hits[i]->id, DVec3(ray.d));
      if (!n) continue;
      spawns.push_back({.ray = &ray, .hit = *hits[i], .direction = Vec3(light_ - p)});
      const DVec3 way = *n + random_point(seed, i);  // cosine-distributed
      spawns.push_back({.ray = &ray, .hit = *hits[i], .direction = Vec3(way)});
    }
    std::vector<std::optional<Vec3>> origins(spawns.size());
    measure(origin, spawns.size(), [&] { bvh_.spawn_origins(spawns, origins); });
    std::vector<Ray> on, to_light;
    for (std::size_t i = 0; i < spawns.size(); ++i) {
      if (!origins[i]) continue;
      const bool is_shadow = i % 2 == 0;
      const Vec3 d = is_shadow ? Vec3(light_ - DVec3(*origins[i])) : spawns[i].direction;
      (is_shadow ? to_light : on)
          .push_back({.o = *origins[i],
                      .t_min = 0,
                      .d = d,
                      .t_max = is_shadow ? 1 : std::numeric_limits<float>::infinity()});
    }
    std::array<bool, kBatch> occluded{};
    measure(shadow, to_light.size(),
            [&] { bvh_.occluded(to_light, std::span(occluded).first(to_light.size())); });
    return on;
  }

  /// Returns the unit normal on the side from which the ray d arrives; nothing for triangles
  /// without area.
  std::optional<DVec3> normal(PrimitiveId id, const DVec3& d) const {
    return bvh_.primitives().visit(id, [&](const auto& shape) -> std::optional<DVec3> {
      if constexpr (std::is_same_v<std::decay_t<decltype(shape)>, Triangle>) {
        const DVec3 a(shape.a);
        const DVec3 n = glm::cross(DVec3(shape.b) - a, DVec3(shape.c) - a);
        if (n != DVec3(0)) return glm::normalize(glm::dot(n, d) > 0 ? -n : n);
      }
      return std::nullopt;
    });
  }

  const Bvh& bvh_;
  DVec3 light_;
  Costs costs_{};
};

/// A scene or its rotated copy, ready for queries.
struct Subject {
  explicit Subject(ArchitectureScene made)
      : architecture(std::move(made)),
        scene(generated::as_scene(architecture)),
        bvh(scene, {.threads = 1}) {}

  [[nodiscard]] PerspectiveCamera view(std::size_t i) const {
    return {.pose = architecture.views[i]};
  }

  ArchitectureScene architecture;
  Scene scene;
  Bvh bvh;
};

Costs measured(const Subject& subject, std::size_t view) {
  return Tracer(subject.bvh, subject.architecture.light)
      .trace(primary_rays(subject.view(view), kSize));
}

void keep_fastest(Costs& best, const Costs& run) {
  for (std::size_t kind = 0; kind < kKinds; ++kind) {
    if (best[kind].questions == 0 || run[kind].seconds < best[kind].seconds) best[kind] = run[kind];
  }
}

double share(double part, const Cost& cost) {
  return part / static_cast<double>(std::max<std::size_t>(cost.questions, 1));
}

void print_row(const std::string& name, const char* kind, const Cost& aligned, const Cost& turned) {
  const auto per_10_000 = [](std::uint64_t count, const Cost& cost) {
    return share(1e4 * static_cast<double>(count), cost);
  };
  const double ns = share(1e9 * aligned.seconds, aligned),
               ns_turned = share(1e9 * turned.seconds, turned);
  std::printf(
      "%-16s %-7s %8zu %8.1f %8.1f %6.2f |%8.1f %8.1f %8.1f %8.2f |%8.1f %8.1f %8.1f %8.2f\n",
      name.c_str(), kind, aligned.questions, ns, ns_turned, ns / ns_turned,
      per_10_000(aligned.stages.edges, aligned), per_10_000(aligned.stages.filters, aligned),
      per_10_000(aligned.stages.grid, aligned), per_10_000(aligned.stages.dyadic, aligned),
      per_10_000(turned.stages.edges, turned), per_10_000(turned.stages.filters, turned),
      per_10_000(turned.stages.grid, turned), per_10_000(turned.stages.dyadic, turned));
  std::fflush(stdout);
}

void compare_rays(const Subject& aligned, const Subject& turned, unsigned runs) {
  for (std::size_t view = 0; view < aligned.architecture.views.size(); ++view) {
    Costs costs{}, turned_costs{};
    for (unsigned i = 0; i < runs; ++i) {
      keep_fastest(costs, measured(aligned, view));
      keep_fastest(turned_costs, measured(turned, view));
    }
    const std::string name = aligned.architecture.name + (view == 0 ? "" : " straight");
    for (std::size_t kind = 0; kind < kKinds; ++kind)
      print_row(name, kKindNames[kind], costs[kind], turned_costs[kind]);
  }
}

double picture_seconds(const Subject& subject, std::uint32_t samples) {
  const PathIntegrator integrator;
  return seconds(1, [&] {
    static_cast<void>(render(subject.scene, subject.view(0), kSize,
                             {.threads = 1, .integrator = &integrator, .samples = samples}));
  });
}

void compare_pictures(const Subject& aligned, const Subject& turned, std::uint32_t samples,
                      unsigned runs) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  double time = infinity, turned_time = infinity;
  for (unsigned i = 0; i < runs; ++i) {
    time = std::min(time, picture_seconds(aligned, samples));
    turned_time = std::min(turned_time, picture_seconds(turned, samples));
  }
  std::printf("%-16s %9.3f %9.3f %6.2f\n", aligned.architecture.name.c_str(), time, turned_time,
              time / turned_time);
  std::fflush(stdout);
}

struct Arguments {
  std::vector<std::string> scenes = generated::architecture_names();
  unsigned runs = 5, picture_samples = 0;
};

Arguments parse(std::span<char*> words) {
  Arguments arguments;
  for (std::size_t i = 1; i < words.size(); ++i) {
    const std::string word = words[i];
    const auto value = [&] {
      if (++i == words.size()) throw std::invalid_argument(word + " needs a value");
      return std::string(words[i]);
    };
    if (word == "--scenes") {
      arguments.scenes = split_names(value());
    } else if (word == "--runs") {
      arguments.runs = number(value());
    } else if (word == "--pictures") {
      arguments.picture_samples = number(value());
    } else {
      throw std::invalid_argument("no option " + word);
    }
  }
  return arguments;
}

void run(const Arguments& arguments) {
  if (arguments.picture_samples == 0) {
    std::printf(
        "%60s per 10^4 questions\n%-16s %-7s %8s %8s %8s %6s |%8s %8s %8s %8s |%8s turned\n", "",
        "scene", "kind", "asked", "ns", "turned", "ratio", "edges", "filters", "grid", "dyadic",
        "");
  } else {
    std::printf("%-16s %9s %9s %6s\n", "scene", "CPU s", "turned", "ratio");
  }
  for (const std::string& name : arguments.scenes) {
    const Subject aligned(generated::architecture(name));
    const Subject turned(generated::turned(generated::architecture(name)));
    if (arguments.picture_samples == 0)
      compare_rays(aligned, turned, arguments.runs);
    else
      compare_pictures(aligned, turned, arguments.picture_samples, arguments.runs);
  }
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  try {
    arguments = parse({argv, static_cast<std::size_t>(argc)});
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "%s\n%s", error.what(), kUsage);
    return 2;
  }
  try {
    run(arguments);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return EXIT_SUCCESS;
}
