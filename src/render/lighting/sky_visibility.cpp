#include "render/lighting/sky_visibility.hpp"

#include "accel/kernels/kernel.hpp"
#include "accel/ray_tracer.hpp"
#include "render/guiding/blurred.hpp"
#include "render/guiding/sky_grid.hpp"
#include "render/lanes/dispatch.hpp"
#include "render/lanes/ray_arrays.hpp"
#include "render/sampling/sobol.hpp"
#include "render/shading/transmittance.hpp"
#include "scene/math/luminance.hpp"
#include "scene/support.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

namespace microtrace {
namespace {

constexpr double kCellsAcross = 16;
/// The margin around the bounds and the cells as a fraction of their sizes, because many walls lie
/// on the boundaries of cells.
constexpr double kMargin = 0.01;
constexpr std::uint32_t kProbes = 16;  // rays that look for the surfaces in a cell; a square
constexpr std::uint32_t kRaysPerBin = 2;

using Values = std::array<float, HemisphereBins::kCount>;

/// Few rays per bin miss light near edges, so neighbors are averaged.
constexpr BlurredGrid kSkyGrid{.rows = HemisphereBins::kRows,
                               .columns = HemisphereBins::kColumns,
                               .is_round = true,
                               .center = 2};

/// The point in float32. Margins may exceed its range.
Vec3 in_range(const DVec3& p) {
  const DVec3 most(double{std::numeric_limits<float>::max()});
  return Vec3(glm::clamp(p, -most, most));
}

std::int32_t cells_along(double extent, double cell_size) {
  return static_cast<std::int32_t>(std::clamp(std::ceil(extent / cell_size), 1.0, kCellsAcross));
}

}  // namespace

/// A point from which rays start, slightly above a surface.
struct SkyVisibility::Start {
  Vec3 p;
  Vec3 n;  ///< the surface's geometric normal on the side of p
};

SkyVisibility::SkyVisibility(const Scene& scene, const Bvh& bvh, const Shading& shading)
    : bvh_(bvh), shading_(shading) {
  std::optional<Extent> bounds;
  ChunkedMeshes chunks;
  for (const ObjectRun& run : scene.objects.runs()) {
    for (std::size_t i = 0; i < run.count; ++i) {
      const std::optional<Extent> extent = extent_of({run, i}, chunks);
      if (!extent) continue;
      if (!bounds) bounds = extent;
      bounds = Extent{.low = glm::min(bounds->low, extent->low),
                      .high = glm::max(bounds->high, extent->high)};
    }
  }
  if (!bounds) return;
  const DVec3 margin = kMargin * (bounds->high - bounds->low);
  low_ = bounds->low - margin;
  high_ = bounds->high + margin;
  const DVec3 extent = high_ - low_;
  grid_.cell_size = std::max({extent.x, extent.y, extent.z}) / kCellsAcross;
  is_enclosed_ = grid_.cell_size > 0 && is_near() && finds_enclosed();
  if (!is_enclosed_) return;
  std::size_t count = 6;
  for (int axis = 0; axis < 3; ++axis) {
    grid_.low[axis] = low_[axis];
    grid_.size[axis] = cells_along(extent[axis], grid_.cell_size);
    count *= static_cast<std::size_t>(grid_.size[axis]);
  }
  cells_.resize(count);
}

// Rays from points that are farther away are tested against all primitives.
bool SkyVisibility::is_near() const {
  const DVec3 most(double{kFarthestCoordinate});
  return glm::all(glm::lessThanEqual(-most, low_)) && glm::all(glm::lessThanEqual(high_, most));
}

// Few rays escape from rooms, and from dense clouds of particles. Among particles, however, rays
// travel less far than a cell is wide, so that a cell's visibility tells little about its points.
bool SkyVisibility::finds_enclosed() const {
  constexpr std::uint32_t kRays = 256, kGreatestPart = kRays / 8;
  constexpr double kLeastCells = 1.5;  // mean distance of hits
  std::uint32_t escaped = 0;
  double hits = 0, distance = 0;
  for (std::uint32_t i = 0; i < kRays; ++i) {
    const sampling::Sobol sobol(0, i);
    const Vec2 xy = sobol.pair(0), z = sobol.pair(1), d = sobol.pair(2);
    const HemisphereBins bins({.axis = 2, .is_down = z.y < 0.5F});
    const auto bin = static_cast<int>(d.x * HemisphereBins::kCount);
    const Ray ray{
        .o = in_range(low_ + (high_ - low_) * DVec3(xy.x, xy.y, z.x)),
        .d = bins.direction(bin, {d.x * HemisphereBins::kCount - static_cast<float>(bin), d.y})};
    const std::optional<Hit> hit = bvh_.intersect(ray);
    if (light_along(ray, hit) > 0) ++escaped;
    if (hit) {
      ++hits;
      distance += double{hit->t};
    }
  }
  return escaped <= kGreatestPart && distance >= kLeastCells * hits * grid_.cell_size;
}

float SkyVisibility::light_along(const Ray& ray, const std::optional<Hit>& hit) const {
  std::uint64_t beyond = 0;
  return luminance(transmittance(bvh_, shading_, PathOptions{}, ray, hit, std::nullopt, beyond));
}

std::size_t SkyVisibility::index(const Vec3& p, const Vec3& n) const {
  std::uint32_t cells[1];
  find_sky_cells<1>(grid_, {{p.x}, {p.y}, {p.z}}, {{n.x}, {n.y}, {n.z}}, cells);
  return cells[0];
}

const SkyVisibility::Cell& SkyVisibility::cell(std::size_t index) const {
  return cells_.get(index, [&] { return fill(index); });
}

std::vector<SkyVisibility::Start> SkyVisibility::starts(std::size_t index,
                                                        const SignedAxis& about) const {
  DVec3 corner;
  std::size_t rest = index;
  for (int axis = 2; axis >= 0; --axis) {
    const auto size = static_cast<std::size_t>(grid_.size[axis]);
    corner[axis] = low_[axis] + (static_cast<double>(rest % size) - kMargin) * grid_.cell_size;
    rest /= size;
  }
  const double edge = grid_.cell_size * (1 + 2 * kMargin);
  constexpr std::uint32_t kMostSurfaces = 4;
  const double above = grid_.cell_size * 0x1p-10;
  std::vector<Start> found;
  for (std::uint32_t i = 0; i < kProbes; ++i) {
    // Probes fall against the axis through the cell, onto surfaces that face the axis.
    const Vec2 place = sampling::Sobol(static_cast<std::uint32_t>(index), i).pair(0);
    DVec3 from = corner;
    from[about.axis] += about.is_down ? 0 : edge;
    from[(about.axis + 1) % 3] += edge * double{place.x};
    from[(about.axis + 2) % 3] += edge * double{place.y};
    const Ray ray{.o = in_range(from), .d = -about.direction(), .t_max = static_cast<float>(edge)};
    std::optional<Hit> hit = bvh_.intersect(ray);
    double last = -above;
    for (std::uint32_t count = 0; hit && count < kMostSurfaces; ++count) {
      const SurfacePoint at = shading_.point(ray, *hit).at;
      const Vec3 n = at.front ? at.n : -at.n;
      const std::optional<Hit> next = bvh_.next(ray, *hit);
      // No light reaches a surface on which another one lies.
      const double here = hit->t;
      const bool is_covered = here - last < above || (next && next->t == hit->t);
      if (!is_covered && -glm::dot(n, ray.d) >= 0.5F)
        found.push_back({.p = in_range(DVec3(at.p) + above * DVec3(n)), .n = n});
      last = here;
      hit = next;
    }
  }
  return found;
}

/// Finds the light that arrives at points from the bins of a hemisphere.
class SkyVisibility::Probe {
 public:
  Probe(const SkyVisibility& visibility, const SignedAxis& about, std::vector<Start> from)
      : visibility_(visibility), bins_(about), from_(std::move(from)) {
    tracer_.begin(visibility.bvh_);
    std::ranges::fill(rays_.t_max, std::numeric_limits<float>::infinity());
    std::ranges::fill(rays_.left, kNoPrimitive);
  }

  /// Traces rays in all bins. `key` scrambles their random numbers, and `round` is the number of
  /// earlier calls.
  void trace(std::uint32_t key, std::uint32_t round) {
    set_rays(key, round);
    LightBlockers blockers(tracer_, visibility_.shading_, PathOptions{});
    const RayColumns rays = columns_of(rays_, count_);
    tracer_.any(rays, blockers.filter(), std::span(hits_).first(count_));
    for (std::size_t i = 0; i < count_; ++i) {
      sum_[bins_of_rays_[i]] += light_along(rays, i, blockers);
      ++traced_[bins_of_rays_[i]];
    }
  }

  /// The light that arrives from each bin, and the number of rays.
  [[nodiscard]] const Values& sum() const { return sum_; }
  [[nodiscard]] const Values& traced() const { return traced_; }

 private:
  static constexpr std::uint32_t kRays = kRaysPerBin * HemisphereBins::kCount;

  void set_rays(std::uint32_t key, std::uint32_t round) {
    const ShadingKernels& kernels = kShadingKernels.best();
    std::uint32_t keys[kShadingLanes], indices[kShadingLanes];
    std::ranges::fill(keys, key);
    static_assert(kRays % kShadingLanes == 0);
    count_ = 0;
    for (std::uint32_t first = 0; first < kRays; first += kShadingLanes) {
      std::iota(std::begin(indices), std::end(indices), round * kRays + first);
      LaneFloats choice, x, y;
      kernels.random_numbers(keys, indices, 1, choice);
      kernels.random_pairs(keys, indices, 2, x, y);
      for (std::uint32_t lane = 0; lane < kShadingLanes; ++lane)
        add_ray((first + lane) / kRaysPerBin, choice[lane], {x[lane], y[lane]});
    }
  }
  /// Adds a ray in a bin, unless it starts below the surface. `choice` selects its origin.
  void add_ray(std::uint32_t bin, float choice, const Vec2& place) {
    const Start& start = from_[static_cast<std::size_t>(choice * static_cast<float>(from_.size()))];
    const Vec3 d = bins_.direction(static_cast<int>(bin), place);
    if (!(glm::dot(d, start.n) > 0)) return;
    put_vector(rays_.o, count_, start.p);
    put_vector(rays_.d, count_, d);
    bins_of_rays_[count_++] = bin;
  }
  [[nodiscard]] float light_along(const RayColumns& rays, std::size_t i,
                                  const LightBlockers& blockers) const {
    if (hits_[i] == kNoPrimitive) return 1;
    if (blockers.blocks(hits_[i])) return 0;
    return visibility_.light_along(rays[i], visibility_.bvh_.intersect(rays[i]));
  }

  const SkyVisibility& visibility_;
  HemisphereBins bins_;
  std::vector<Start> from_;
  RayTracer tracer_;
  std::size_t count_ = 0;  // of rays
  RayArrays rays_;
  std::array<std::uint32_t, kRays> bins_of_rays_;
  std::array<PrimitiveId, kRays> hits_;
  Values sum_{}, traced_{};
};

std::unique_ptr<const SkyVisibility::Cell> SkyVisibility::fill(std::size_t index) const {
  auto cell = std::make_unique<Cell>();
  cell->about = SignedAxis::of_face(index / (cells_.count() / 6));
  std::vector<Start> from = starts(index, cell->about);
  if (from.empty()) return cell;
  const auto probe = std::make_unique<Probe>(*this, cell->about, std::move(from));
  const auto total = [](const Values& values) {
    return std::accumulate(values.begin(), values.end(), 0.0F);
  };
  // Small openings need more rays.
  constexpr std::uint32_t kMostRounds = 5;
  constexpr float kSmallPart = 1.0F / 16;
  for (std::uint32_t round = 0; round < kMostRounds; ++round) {
    probe->trace(static_cast<std::uint32_t>(index), round);
    if (total(probe->sum()) > kSmallPart * total(probe->traced())) break;
  }
  Values light = probe->sum();
  for (std::size_t bin = 0; bin < light.size(); ++bin)
    light[bin] /= std::max(probe->traced()[bin], 1.0F);
  const Values sums = blurred(light, kSkyGrid);
  for (std::size_t bin = 0; bin < sums.size(); ++bin)
    cell->bins[bin] =
        static_cast<std::uint8_t>(std::lround(255 * (sums[bin] / float(kSkyGrid.weight()))));
  return cell;
}

}  // namespace microtrace
