#include "vs_embree_compare.hpp"

#include "rays.hpp"
#include "vs_embree_question.hpp"
#include "vs_embree_timing.hpp"

#include <microtrace/bvh.hpp>

#include <array>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

namespace microtrace::bench {
namespace {

// Embree's scenes for one instruction set. Which set is best depends on the kind of rays.
struct Peer {
  std::string isa;
  std::unique_ptr<PeerScene> fast, robust;
};

struct Choice {
  const PeerScene* scene = nullptr;
  PeerMode mode;
  std::string name;
};

std::unique_ptr<PeerScene> built(const Mesh& mesh, const PeerOptions& options) {
  auto scene = std::make_unique<PeerScene>(mesh, options);
  scene->commit();
  return scene;
}

std::vector<Peer> make_peers(const Mesh& mesh, unsigned threads) {
  const auto make = [&](const std::string& name, const std::string& isa) {
    return Peer{.isa = name,
                .fast = built(mesh, {.isa = isa, .threads = threads}),
                .robust = built(mesh, {.isa = isa, .robust = true, .threads = threads})};
  };
  std::vector<Peer> peers;
  peers.push_back(make("native", ""));
  if (peers[0].fast->is_16_wide()) {
    peers[0].isa = "avx512";
    peers.push_back(make("avx2", "avx2"));
  }
  return peers;
}

std::string name_of(const std::string& isa, PeerMode mode) {
  return isa + (mode.width == kStream ? " stream" : " x" + std::to_string(mode.width)) +
         (mode.coherent ? " coherent" : "");
}

// The fastest way to ask Embree such a question.
Choice best_choice(const std::vector<Peer>& peers, bool robust, Question& question,
                   unsigned threads) {
  Choice best;
  double best_seconds = std::numeric_limits<double>::infinity();
  for (const Peer& peer : peers) {
    const PeerScene& scene = robust ? *peer.robust : *peer.fast;
    for (const PeerMode mode : kPeerModes) {
      std::vector<double> times;
      for (int i = 0; i < 3; ++i)
        times.push_back(seconds(threads, [&] { question.ask_embree(scene, mode, threads); }));
      if (median(times) >= best_seconds) continue;
      best_seconds = median(times);
      best = {.scene = &scene, .mode = mode, .name = name_of(peer.isa, mode)};
    }
  }
  return best;
}

// 0 where a hierarchy can't tell.
std::size_t bytes_of(const auto& bvh) {
  if constexpr (requires { bvh.memory(); })
    return bvh.memory();
  else
    return 0;
}

BuildRow compare_builds(const BenchScene& scene, const CompareOptions& options,
                        std::optional<Bvh>& bvh) {
  const Mesh& mesh = scene.mesh();
  const auto triangles = static_cast<double>(mesh.triangles.size());
  BuildRow row{.scene = scene.name, .triangles = mesh.triangles.size(), .threads = options.threads};
  std::vector<double> ours, theirs;
  for (unsigned i = 0; i < options.runs; ++i) {
    bvh.reset();
    ours.push_back(seconds(options.threads, [&] {
      bvh.emplace(scene.scene, BvhOptions{.threads = options.threads});
    }));
    PeerScene peer(mesh, {.threads = options.threads});
    const auto before = static_cast<double>(peer.bytes());
    theirs.push_back(seconds(options.threads, [&] { peer.commit(); }));
    row.bytes_per_triangle_embree = (static_cast<double>(peer.bytes()) - before) / triangles;
  }
  row.ms_microtrace = 1e3 * median(ours);
  row.ms_embree = 1e3 * median(theirs);
  row.bytes_per_triangle_microtrace = static_cast<double>(bytes_of(*bvh)) / triangles;
  return row;
}

RayRow compare_rays(const Bvh& bvh, const std::vector<Peer>& peers, Kind kind, Question& question,
                    const CompareOptions& options) {
  const unsigned threads = options.threads;
  Question some(kind, sample(question.rays(), 16 * kTileRays, 8));
  const Choice fast = best_choice(peers, false, some, threads);
  const Choice robust = best_choice(peers, true, some, threads);
  RayRow row{.threads = threads,
             .rays = question.size(),
             .mode_fast = fast.name,
             .mode_robust = robust.name};
  const auto ask = [&](const Choice& choice) {
    question.ask_embree(*choice.scene, choice.mode, threads);
  };
  ask(robust);
  question.ask_microtrace(bvh, threads);
  row.disagreements_robust = question.disagreements();
  ask(fast);
  row.disagreements_fast = question.disagreements();

  const std::array<std::function<void()>, 3> programs{
      [&] { question.ask_microtrace(bvh, threads); }, [&] { ask(fast); }, [&] { ask(robust); }};
  std::array<std::vector<double>, 3> times;
  // Each run begins with another program: what the one before leaves in the caches helps none more.
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
  const Mesh& mesh = scene.mesh();
  const std::vector<Peer> peers = make_peers(mesh, options.threads);

  const auto add = [&](Kind kind, const char* name, Question& question) {
    RayRow row = compare_rays(*bvh, peers, kind, question, options);
    row.scene = scene.name;
    row.kind = name;
    rows.rays.push_back(std::move(row));
  };
  Question primary(Kind::primary, primary_rays(scene.camera, options.size));
  add(Kind::primary, "primary", primary);
  const Traced traced{.rays = primary.rays(), .hits = primary.hits()};
  const double size = extent(mesh);
  {
    auto rays = cosine_rays(mesh, traced, size, std::numeric_limits<float>::infinity(), 1);
    shuffle(rays, 2);
    Question bounce(Kind::bounce, std::move(rays));
    add(Kind::bounce, "bounce", bounce);
  }
  Question occlusion(Kind::occlusion,
                     cosine_rays(mesh, traced, size, static_cast<float>(0.05 * size), 3));
  add(Kind::occlusion, "occlusion", occlusion);
  return rows;
}

}  // namespace microtrace::bench
