#include "vs_embree_compare.hpp"

#include "rays.hpp"
#include "timing.hpp"
#include "vs_embree_question.hpp"

#include <microtrace/bvh.hpp>
#include <microtrace/stage_counts.hpp>

#include <array>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

namespace microtrace::bench {
namespace {

// An Embree scene with one combination of instruction set and build quality. The best combination
// depends on the mesh and the kind of rays.
struct Peer {
  std::string name;
  bool robust;
  std::unique_ptr<PeerScene> scene;
};

struct Choice {
  const PeerScene* scene = nullptr;
  PeerMode mode;
  std::string name;
};

// Robust scenes need only one quality: high quality differs from medium by spatial splits, which
// Embree uses only in non-robust scenes.
std::vector<Peer> make_peers(const Scene& scene, unsigned threads) {
  std::vector<Peer> peers;
  const auto add = [&](const std::string& name, PeerOptions options) {
    options.threads = threads;
    peers.push_back({.name = name,
                     .robust = options.robust,
                     .scene = std::make_unique<PeerScene>(scene, options)});
    peers.back().scene->commit();
  };
  const auto add_all = [&](const std::string& name, const std::string& isa) {
    add(name + " high", {.isa = isa});
    add(name + " medium", {.isa = isa, .quality = RTC_BUILD_QUALITY_MEDIUM});
    add(name, {.isa = isa, .robust = true});
  };
  const bool avx512 = PeerScene(scene, {}).is_16_wide();
  add_all(avx512 ? "avx512" : "native", "");
  if (avx512) add_all("avx2", "avx2");
  return peers;
}

std::string name_of(const std::string& scene, PeerMode mode) {
  return scene + (mode.width == kStream ? " stream" : " x" + std::to_string(mode.width)) +
         (mode.coherent ? " coherent" : "");
}

// Determines Embree's fastest mode for the query with one thread, because processor time varies
// less than elapsed time.
Choice best_choice(const std::vector<Peer>& peers, bool robust, Question& question) {
  Choice best;
  double best_seconds = std::numeric_limits<double>::infinity();
  for (const Peer& peer : peers) {
    if (peer.robust != robust) continue;
    for (const PeerMode mode : kPeerModes) {
      for (int i = 0; i < 3; ++i) {
        const double time = seconds(1, [&] { question.ask_embree(*peer.scene, mode, 1); });
        if (time >= best_seconds) continue;
        best_seconds = time;
        best = {.scene = peer.scene.get(), .mode = mode, .name = name_of(peer.name, mode)};
      }
    }
  }
  return best;
}

BuildRow compare_builds(const BenchScene& scene, const CompareOptions& options,
                        std::optional<Bvh>& bvh) {
  const std::size_t count = Primitives(scene.scene).count();
  const auto triangles = static_cast<double>(count);
  BuildRow row{.scene = scene.name, .triangles = count, .threads = options.threads};
  std::vector<double> ours, high, medium;
  const auto build_embree = [&](RTCBuildQuality quality, std::vector<double>& times) {
    PeerScene peer(scene.scene, {.quality = quality, .threads = options.threads});
    const auto before = static_cast<double>(peer.bytes());
    times.push_back(seconds(options.threads, [&] { peer.commit(); }));
    return (static_cast<double>(peer.bytes()) - before) / triangles;
  };
  for (unsigned i = 0; i < options.runs; ++i) {
    bvh.reset();
    ours.push_back(seconds(options.threads, [&] {
      bvh.emplace(scene.scene, BvhOptions{.threads = options.threads});
    }));
    build_embree(RTC_BUILD_QUALITY_MEDIUM, medium);
    row.bytes_per_triangle_embree = build_embree(RTC_BUILD_QUALITY_HIGH, high);
  }
  row.ms_microtrace = 1e3 * median(ours);
  row.ms_embree = 1e3 * median(high);
  row.ms_embree_medium = 1e3 * median(medium);
  row.bytes_per_triangle_microtrace = static_cast<double>(bvh->memory()) / triangles;
  return row;
}

RayRow compare_rays(const Bvh& bvh, const std::vector<Peer>& peers, Kind kind, Question& question,
                    const CompareOptions& options) {
  const unsigned threads = options.threads;
  Question some(kind, sample(question.rays(), 16 * kTileRays, 8));
  const Choice fast = best_choice(peers, false, some);
  const Choice robust = best_choice(peers, true, some);
  RayRow row{.threads = threads,
             .rays = question.size(),
             .mode_fast = fast.name,
             .mode_robust = robust.name};
  const auto ask = [&](const Choice& choice) {
    question.ask_embree(*choice.scene, choice.mode, threads);
  };
  ask(robust);
  const StageCounts before = stage_counts();
  question.ask_microtrace(bvh, threads);
  const StageCounts after = stage_counts();
  const auto per_ray = [&](std::uint64_t count) {
    return static_cast<double>(count) / static_cast<double>(question.size());
  };
  row.edges = per_ray(after.edges - before.edges);
  row.filters = per_ray(after.filters - before.filters);
  row.exact = per_ray(after.grid + after.dyadic - before.grid - before.dyadic);
  row.disagreements_robust = question.disagreements();
  ask(fast);
  row.disagreements_fast = question.disagreements();

  const std::array<std::function<void()>, 3> programs{
      [&] { question.ask_microtrace(bvh, threads); }, [&] { ask(fast); }, [&] { ask(robust); }};
  std::array<std::vector<double>, 3> times;
  // Each round starts with a different program, so that no program always profits from the cache
  // contents that another one leaves.
  for (unsigned i = 0; i < 3 * options.runs; ++i) {
    const std::size_t turn = (i + i / 3) % 3;
    times[turn].push_back(seconds(threads, programs[turn]));
  }
  const double mrays = 1e-6 * static_cast<double>(question.size());
  row.mrays_microtrace = mrays / median(times[0]);
  row.mrays_embree_fast = mrays / median(times[1]);
  row.mrays_embree_robust = mrays / median(times[2]);
  return row;
}

}  // namespace

SceneRows compare(const BenchScene& scene, const CompareOptions& options) {
  SceneRows rows;
  std::optional<Bvh> bvh;
  rows.build = compare_builds(scene, options, bvh);
  const std::vector<Peer> peers = make_peers(scene.scene, options.threads);

  const auto add = [&](Kind kind, const char* name, Question& question) {
    RayRow row = compare_rays(*bvh, peers, kind, question, options);
    row.scene = scene.name;
    row.kind = name;
    rows.rays.push_back(std::move(row));
  };
  Question primary(Kind::primary, primary_rays(scene.camera, options.size));
  add(Kind::primary, "primary", primary);
  const Traced traced{.rays = primary.rays(), .hits = primary.hits()};
  const double size = extent(scene.scene);
  {
    auto rays =
        cosine_rays(bvh->primitives(), traced, size, std::numeric_limits<float>::infinity(), 1);
    shuffle(rays, 2);
    Question bounce(Kind::bounce, std::move(rays));
    add(Kind::bounce, "bounce", bounce);
  }
  Question occlusion(Kind::occlusion, cosine_rays(bvh->primitives(), traced, size,
                                                  static_cast<float>(0.05 * size), 3));
  add(Kind::occlusion, "occlusion", occlusion);
  return rows;
}

}  // namespace microtrace::bench
