#pragma once
/// Rays that both programs trace, and the results.

#include "vs_embree_peer.hpp"

#include <microtrace/bvh.hpp>

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace microtrace::bench {

enum class Kind {
  primary,   ///< nearest hits of camera rays, tile by tile
  bounce,    ///< nearest hits of cosine-distributed rays, shuffled
  occlusion  ///< any hits of short cosine-distributed rays, tile by tile
};

/// The rays of one kind and the results of both programs. Each run overwrites the results.
class Question {
 public:
  Question(Kind kind, std::vector<Ray> rays);

  void ask_microtrace(const Bvh& bvh, unsigned threads);
  void ask_embree(const PeerScene& scene, PeerMode mode, unsigned threads);

  /// Returns the fraction of rays for which the last results differ in hit or miss, or in the
  /// triangle.
  [[nodiscard]] double disagreements() const;

  [[nodiscard]] std::size_t size() const { return rays_.size(); }
  [[nodiscard]] std::span<const Ray> rays() const { return rays_; }
  /// Returns the hits of microtrace; none for occlusion rays.
  [[nodiscard]] std::span<const std::optional<Hit>> hits() const { return hits_; }

 private:
  Kind kind_;
  std::vector<Ray> rays_;
  PeerRays packed_;
  std::vector<std::optional<Hit>> hits_;
  std::vector<PeerHit> peer_hits_;
  std::unique_ptr<bool[]> occluded_;
  std::vector<std::uint8_t> peer_occluded_;
};

}  // namespace microtrace::bench
