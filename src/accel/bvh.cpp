#include "accel/build/tree.hpp"
#include "accel/bundle.hpp"
#include "accel/kernel_rays.hpp"
#include "accel/kernels/dispatch.hpp"
#include "accel/slow_path.hpp"
#include "accel/tile_judge.hpp"

#include <microtrace/bvh.hpp>

#include <algorithm>
#include <cassert>
#include <vector>

namespace microtrace {

struct Bvh::Impl {
  Impl(const Scene& scene, const BvhOptions& options);

  [[nodiscard]] TreeView view() const {
    return {.nodes = tree.nodes.data(),
            .blocks = tree.blocks.data(),
            .others = tree.others.data(),
            .root = tree.root};
  }

  [[nodiscard]] std::optional<Hit> intersect(const Ray& ray) const;
  [[nodiscard]] bool occluded(const Ray& ray) const;

  /// Rays that make a tile (see tile_length).
  void intersect_tile(std::span<const Ray> rays, std::span<std::optional<Hit>> hits) const;

  Primitives primitives;
  std::vector<PrimitiveId> outside;  // of the tree: asked one by one
  Tree tree;
  bool has_tree = false;
  const Kernels* kernels = &best_kernels();
};

Bvh::Impl::Impl(const Scene& scene, const BvhOptions& options) : primitives(scene) {
  // So few are asked sooner than a tree is walked.
  constexpr PrimitiveId kFew = 16;
  if (primitives.count() <= kFew) {
    primitives.for_each([&](PrimitiveId id, const auto&) { outside.push_back(id); });
    return;
  }
  tree = build_tree(primitives, {.fast = options.fast_build, .threads = options.threads});
  outside = std::move(tree.unbounded);
  has_tree = !tree.blocks.empty() || !tree.others.empty();
}

namespace {

// Asks every primitive: for rays whose size the kernels' error bounds don't cover.
std::optional<Hit> ask_all(const Primitives& primitives, const Ray& ray) {
  if (!exact::is_valid(ray)) return std::nullopt;
  Bundle bundle(primitives, std::span(&ray, 1));
  primitives.for_each([&](PrimitiveId id, const auto& shape) { bundle.meet(id, shape); });
  return bundle.hit(0);
}

// How many rays from the front make a tile: suited to kernels, with the first one's origin.
std::size_t tile_length(std::span<const Ray> rays) {
  const auto belongs = [&](const Ray& ray) { return ray.o == rays[0].o && suits_kernels(ray); };
  const auto front = rays.first(std::min(rays.size(), Bundle::kCapacity));
  return static_cast<std::size_t>(std::find_if_not(front.begin(), front.end(), belongs) -
                                  front.begin());
}

}  // namespace

std::optional<Hit> Bvh::Impl::intersect(const Ray& ray) const {
  if (!suits_kernels(ray)) return ask_all(primitives, ray);
  Judge judge(primitives, ray);
  Best best = no_hit(ray);
  for (const PrimitiveId id : outside) judge.consider(id, best);
  if (has_tree) kernels->closest(view(), kernel_ray(ray), judge.slow_path(), best);
  if (best.id == kNoPrimitive) return std::nullopt;
  return judge.hit(best.id);
}

bool Bvh::Impl::occluded(const Ray& ray) const {
  if (!suits_kernels(ray)) return ask_all(primitives, ray).has_value();
  Judge judge(primitives, ray);
  Best best = no_hit(ray);
  for (const PrimitiveId id : outside) {
    judge.consider(id, best);
    if (best.id != kNoPrimitive) return true;
  }
  return has_tree && kernels->any(view(), kernel_ray(ray), judge.slow_path());
}

void Bvh::Impl::intersect_tile(std::span<const Ray> rays,
                               std::span<std::optional<Hit>> hits) const {
  if (has_tree) {
    TileJudge judge(primitives, rays);
    KernelTile tile;
    fill_tile(rays, tile);
    judge.begin(tile, outside);
    kernels->closest_of_tile(view(), tile, judge.slow_path());
    for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = judge.hit(tile, i);
  } else {
    Bundle bundle(primitives, rays);
    for (const PrimitiveId id : outside)
      primitives.visit(id, [&](const auto& shape) { bundle.meet(id, shape); });
    for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = bundle.hit(i);
  }
}

Bvh::Bvh(const Scene& scene, const BvhOptions& options)
    : impl_(std::make_unique<const Impl>(scene, options)) {}
Bvh::~Bvh() = default;
Bvh::Bvh(Bvh&&) noexcept = default;
Bvh& Bvh::operator=(Bvh&&) noexcept = default;

const Primitives& Bvh::primitives() const {
  return impl_->primitives;
}

std::optional<Hit> Bvh::intersect(const Ray& ray) const {
  return impl_->intersect(ray);
}

bool Bvh::occluded(const Ray& ray) const {
  return impl_->occluded(ray);
}

void Bvh::intersect(std::span<const Ray> rays, std::span<std::optional<Hit>> hits) const {
  assert(rays.size() == hits.size());
  while (!rays.empty()) {
    const std::size_t length = tile_length(rays);
    // A few rays don't repay what a tile costs.
    if (length >= 8)
      impl_->intersect_tile(rays.first(length), hits);
    else
      hits[0] = intersect(rays[0]);
    const std::size_t done = length >= 8 ? length : 1;
    rays = rays.subspan(done);
    hits = hits.subspan(done);
  }
}

}  // namespace microtrace
