#include "vs_embree_compare.hpp"

#include "accel/kernels/kernel.hpp"
#include "rays.hpp"
#include "vs_embree_peer.hpp"
#include "vs_embree_timing.hpp"

#include <microtrace/bvh.hpp>

#include <algorithm>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

namespace microtrace::bench {
namespace {

enum class Kind { primary, bounce, occlusion };

/// One question of both programs: the rays, and room for the answers.
struct Question {
  Question(Kind k, std::vector<Ray> r) : kind(k), rays(std::move(r)), packed(rays) {
    (kind == Kind::occlusion ? any : peer_any).resize(rays.size());
    if (kind == Kind::occlusion)
      peer_any.resize(rays.size());
    else {
      hits.resize(rays.size());
      peer_hits.resize(rays.size());
    }
  }

  Kind kind;
  std::vector<Ray> rays;
  PeerRays packed;
  std::vector<std::optional<Hit>> hits;
  std::vector<PeerHit> peer_hits;
  std::vector<std::uint8_t> any, peer_any;
};

}  // namespace
}  // namespace microtrace::bench
