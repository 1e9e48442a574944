#include "render/guiding/sky_visibility.hpp"

#include "render/guiding/blurred.hpp"
#include "render/sampling/hash.hpp"
#include "render/sampling/sobol.hpp"
#include "render/shading/transmittance.hpp"
#include "scene/support.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

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

std::size_t cells_along(double extent, double cell_size) {
  return static_cast<std::size_t>(std::clamp(std::ceil(extent / cell_size), 1.0, kCellsAcross));
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
  for (const Object& object : scene.objects) {
    const std::optional<Extent> extent = extent_of(object.shape, chunks);
    if (!extent) continue;
    if (!bounds) bounds = extent;
    bounds = Extent{.low = glm::min(bounds->low, extent->low),
                    .high = glm::max(bounds->high, extent->high)};
  }
  if (!bounds) return;
  const DVec3 margin = kMargin * (bounds->high - bounds->low);
  low_ = bounds->low - margin;
  high_ = bounds->high + margin;
  const DVec3 extent = high_ - low_;
  cell_size_ = std::max({extent.x, extent.y, extent.z}) / kCellsAcross;
  is_enclosed_ = cell_size_ > 0 && finds_enclosed();
  if (!is_enclosed_) return;
  std::size_t count = 6;
  for (int axis = 0; axis < 3; ++axis) {
    size_[axis] = cells_along(extent[axis], cell_size_);
    count *= size_[axis];
  }
  cells_.resize(count);
}

bool SkyVisibility::finds_enclosed() const {
  constexpr std::uint32_t kRays = 256, kGreatestPart = kRays / 8;
  std::uint32_t escaped = 0;
  for (std::uint32_t i = 0; i < kRays; ++i) {
    const sampling::Sobol sobol(0, i);
    const Vec2 xy = sobol.pair(0), z = sobol.pair(1), d = sobol.pair(2);
    const HemisphereBins bins({.axis = 2, .is_down = z.y < 0.5F});
    const auto bin = static_cast<int>(d.x * HemisphereBins::kCount);
    const Ray ray{
        .o = in_range(low_ + (high_ - low_) * DVec3(xy.x, xy.y, z.x)),
        .d = bins.direction(bin, {d.x * HemisphereBins::kCount - static_cast<float>(bin), d.y})};
    if (light_along(ray, bvh_.intersect(ray)) > 0) ++escaped;
  }
  return escaped <= kGreatestPart;
}

float SkyVisibility::light_along(const Ray& ray, const std::optional<Hit>& hit) const {
  std::uint64_t beyond = 0;
  return transmittance(bvh_, shading_, true, ray, hit, std::nullopt, beyond);
}

std::size_t SkyVisibility::index(const Vec3& p, const Vec3& n) const {
  const SignedAxis about = SignedAxis::nearest(n);
  std::size_t index = face_index(about);
  for (int axis = 0; axis < 3; ++axis) {
    const double place = (double{p[axis]} - low_[axis]) / cell_size_;
    const auto last = static_cast<double>(size_[axis] - 1);
    index = index * size_[axis] + static_cast<std::size_t>(std::clamp(place, 0.0, last));
  }
  return index;
}

const SkyVisibility::Cell& SkyVisibility::cell(std::size_t index) const {
  return cells_.get(index, [&] { return fill(index); });
}

std::vector<SkyVisibility::Start> SkyVisibility::starts(std::size_t index,
                                                        const SignedAxis& about) const {
  DVec3 corner;
  std::size_t rest = index;
  for (int axis = 2; axis >= 0; --axis) {
    corner[axis] = low_[axis] + (static_cast<double>(rest % size_[axis]) - kMargin) * cell_size_;
    rest /= size_[axis];
  }
  const double edge = cell_size_ * (1 + 2 * kMargin);
  constexpr std::uint32_t kMostLayers = 4;
  const double above = cell_size_ * 0x1p-10;
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
    for (std::uint32_t layer = 0; hit && layer < kMostLayers; ++layer) {
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

/// The light that arrives from each bin, and the number of rays.
struct SkyVisibility::Light {
  Values sum{}, rays{};
};

void SkyVisibility::gather(std::uint32_t key, std::uint32_t round, const std::vector<Start>& from,
                           const HemisphereBins& bins, Light& light) const {
  std::vector<Ray> rays;
  std::vector<std::size_t> bin_of_ray;
  for (std::uint32_t i = 0; i < kRaysPerBin * HemisphereBins::kCount; ++i) {
    const std::uint32_t bin = i / kRaysPerBin;
    const sampling::Sobol sobol(key, round * kRaysPerBin * HemisphereBins::kCount + i);
    const Start& start =
        from[static_cast<std::size_t>(sobol.one(1) * static_cast<float>(from.size()))];
    const Vec3 d = bins.direction(static_cast<int>(bin), sobol.pair(2));
    if (!(glm::dot(d, start.n) > 0)) continue;
    rays.push_back({.o = start.p, .t_min = 0, .d = d});
    bin_of_ray.push_back(bin);
  }
  std::vector<std::optional<Hit>> hits(rays.size());
  bvh_.intersect(rays, hits);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    light.sum[bin_of_ray[i]] += light_along(rays[i], hits[i]);
    ++light.rays[bin_of_ray[i]];
  }
}

std::unique_ptr<const SkyVisibility::Cell> SkyVisibility::fill(std::size_t index) const {
  auto cell = std::make_unique<Cell>();
  const std::size_t face = index / (size_[0] * size_[1] * size_[2]);
  cell->about = {.axis = static_cast<int>(face / 2), .is_down = face % 2 != 0};
  const std::vector<Start> from = starts(index, cell->about);
  if (from.empty()) return cell;
  const HemisphereBins bins(cell->about);
  Light light;
  const auto arriving = [&] { return std::accumulate(light.sum.begin(), light.sum.end(), 0.0F); };
  const auto traced = [&] { return std::accumulate(light.rays.begin(), light.rays.end(), 0.0F); };
  // Small openings need more rays.
  constexpr std::uint32_t kMostRounds = 5;
  constexpr float kSmallPart = 1.0F / 16;
  for (std::uint32_t round = 0; round < kMostRounds; ++round) {
    gather(static_cast<std::uint32_t>(index), round, from, bins, light);
    if (arriving() > kSmallPart * traced()) break;
  }
  for (std::size_t bin = 0; bin < light.sum.size(); ++bin)
    light.sum[bin] /= std::max(light.rays[bin], 1.0F);
  const Values sums = blurred(light.sum, kSkyGrid);
  for (std::size_t bin = 0; bin < sums.size(); ++bin)
    cell->bins[bin] =
        static_cast<std::uint8_t>(std::lround(255 * (sums[bin] / float(kSkyGrid.weight()))));
  return cell;
}

}  // namespace microtrace
