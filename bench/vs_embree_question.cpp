#include "vs_embree_question.hpp"

#include "rays.hpp"
#include "timing.hpp"

#include <algorithm>
#include <utility>

namespace microtrace::bench {

Question::Question(Kind kind, std::vector<Ray> rays)
    : kind_(kind), rays_(std::move(rays)), packed_(rays_) {
  if (kind_ == Kind::occlusion) {
    occluded_ = std::make_unique<bool[]>(size());
    peer_occluded_.resize(size());
  } else {
    hits_.resize(size());
    peer_hits_.resize(size());
  }
}

void Question::ask_microtrace(const Bvh& bvh, unsigned threads) {
  split(threads, size(), [&](std::size_t begin, std::size_t end) {
    if (kind_ == Kind::occlusion) {
      bvh.occluded(std::span(rays_).subspan(begin, end - begin),
                   std::span(occluded_.get(), size()).subspan(begin, end - begin));
      return;
    }
    const std::size_t step = kind_ == Kind::primary ? kTileRays : end - begin;
    for (std::size_t i = begin; i < end; i += step) {
      const std::size_t n = std::min(step, end - i);
      bvh.intersect(std::span(rays_).subspan(i, n), std::span(hits_).subspan(i, n));
    }
  });
}

void Question::ask_embree(const PeerScene& scene, PeerMode mode, unsigned threads) {
  split(threads, size(), [&](std::size_t begin, std::size_t end) {
    if (kind_ == Kind::occlusion)
      scene.occluded(mode, packed_, begin, end, peer_occluded_);
    else
      scene.intersect(mode, packed_, begin, end, peer_hits_);
  });
}

double Question::disagreements() const {
  std::size_t different = 0;
  for (std::size_t i = 0; i < size(); ++i) {
    if (kind_ == Kind::occlusion)
      different += occluded_[i] != peer_occluded_[i];
    else
      different += (hits_[i] ? hits_[i]->id : kMiss) != peer_hits_[i].id;
  }
  return static_cast<double>(different) / static_cast<double>(std::max<std::size_t>(size(), 1));
}

}  // namespace microtrace::bench
