#include "accel/tile_judge.hpp"

namespace microtrace {
namespace {

void put(KernelTile& tile, std::size_t i, const Best& best) {
  tile.best_lo[i] = best.lo;
  tile.best_hi[i] = best.hi;
  if (tile.best_id[i] != best.id) tile.best_place[i] = kNoPlace;
  tile.best_id[i] = best.id;
}

}  // namespace

Bundle& TileJudge::bundle() {
  if (!bundle_) bundle_.emplace(*primitives_, rays_);
  return *bundle_;
}

void TileJudge::begin(KernelTile& tile, std::span<const PrimitiveId> ids) {
  if (ids.empty()) return;
  for (const PrimitiveId id : ids)
    primitives_->visit(id, [&](const auto& shape) { bundle().meet(id, shape); });
  for (std::size_t i = 0; i < rays_.size(); ++i) put(tile, i, bundle().best(i));
}

void TileJudge::consider_all(std::uint32_t id, KernelTile& tile) {
  const auto consider = [&](std::size_t i, const Verdict& verdict) {
    if (verdict.certainty == Certainty::miss || verdict.lo > tile.best_hi[i] ||
        tile.best_id[i] == id)
      return;
    Best best{.lo = tile.best_lo[i], .hi = tile.best_hi[i], .id = tile.best_id[i]};
    if (verdict.certainty == Certainty::hit && verdict.hi < best.lo)
      best = outwards(verdict.lo, verdict.hi, id);
    else
      Judge(*primitives_, rays_[i]).consider(id, best);
    put(tile, i, best);
  };
  primitives_->visit(id, [&](const auto& shape) { bundle().for_each_verdict(shape, consider); });
}

TileSlowPath TileJudge::slow_path() {
  return {.context = this,
          .consider =
              [](void* context, int ray, std::uint32_t id, Best& best) {
                const auto* judge = static_cast<const TileJudge*>(context);
                Judge(*judge->primitives_, judge->rays_[static_cast<std::size_t>(ray)])
                    .consider(id, best);
              },
          .consider_all =
              [](void* context, std::uint32_t id, KernelTile& tile) {
                static_cast<TileJudge*>(context)->consider_all(id, tile);
              }};
}

}  // namespace microtrace
