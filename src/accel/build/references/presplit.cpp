#include "accel/build/references/presplit.hpp"

#include "accel/build/area.hpp"
#include "accel/build/references/shape_box.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace microtrace::build {
namespace {

// The constants were found by experiment. They affect speed, but never results.
//
// A triangle is split if the useless area of its box, halved once per Grid::level, exceeds a limit:
// kLeastSplit times the area of the whole scene's box, divided by the number of primitives. The
// number of splits is kCutsAtLeast times the fourth root of the ratio of this area to the limit,
// rounded down. The paper uses the cube root; the fourth root is slightly better and doesn't depend
// on the C library.
constexpr float kCutsAtLeast = 1.5F;

// The useless area is the part of the box's area that exceeds kUseful times the total area of the
// triangle's projections along the three axes. However finely an oblique triangle is split, the
// areas of its pieces' boxes sum to about twice its projections. The box of an axis-aligned
// triangle has that area without splits.
constexpr float kUseful = 2.5F;

float fourth_root(float x) {
  return std::sqrt(std::sqrt(x));
}

int longest_axis(const Box& b) {
  const Float4 e = half_extent(b);
  return e[0] >= e[1] && e[0] >= e[2] ? 0 : e[1] >= e[2] ? 1 : 2;
}

// The planes that halve the scene's box, then its halves, and so on. The upper levels of the tree
// will split near these planes, so triangles are best split there.
class Grid {
 public:
  explicit Grid(const Box& whole) : origin_(whole.lo) {
    for (int k = 0; k < 3; ++k) {
      const float extent = whole.hi[k] - whole.lo[k];
      if (extent > 0x1p-100F && extent < std::numeric_limits<float>::infinity())
        scale_[k] = 0.9999F * static_cast<float>(kCells) / extent;
    }
  }

  // Returns the number of halvings along the axis before the first plane that intersects the box.
  [[nodiscard]] int level(const Box& b, int axis) const {
    return std::countl_zero(cell(b.lo, axis) ^ cell(b.hi, axis)) - (32 - kLevels);
  }
  [[nodiscard]] int level(const Box& b) const {
    return std::min({level(b, 0), level(b, 1), level(b, 2)});
  }

  // Returns the position of that plane, or the middle of the box if the plane would cut off too
  // little.
  [[nodiscard]] float plane(const Box& b, int axis) const {
    const float middle = b.lo[axis] * 0.5F + b.hi[axis] * 0.5F;
    const int at = level(b, axis);
    if (at >= kLevels) return middle;
    const std::uint32_t first = cell(b.hi, axis) >> (kLevels - 1 - at) << (kLevels - 1 - at);
    const float plane = origin_[axis] + static_cast<float>(first) / scale_[axis];
    const float least = (b.hi[axis] - b.lo[axis]) * 0.1F;
    return plane > b.lo[axis] + least && plane < b.hi[axis] - least ? plane : middle;
  }

 private:
  static constexpr int kLevels = 20;
  static constexpr std::uint32_t kCells = 1U << kLevels;

  [[nodiscard]] std::uint32_t cell(Float4 p, int axis) const {
    return static_cast<std::uint32_t>((p[axis] - origin_[axis]) * scale_[axis]);
  }

  Float4 origin_, scale_{};
};

struct Candidate {
  PrimitiveId id;
  float priority;
};

class Splitter {
 public:
  explicit Splitter(References& references)
      : references_(references), reader_(references), grid_(references.box), area_(references.box) {
    least_ = area_(references.box) * kLeastSplit / static_cast<float>(references.items.size());
  }

  void split_all() {
    if (!(least_ > 0)) return;  // the scene is a single point
    for (const PrimitiveId id : references_.large) consider(id);
    if (candidates_.empty()) return;
    const float most = kCutsAtLeast / fourth_root(least_), scale = within_budget(most);
    std::vector<bool> is_split(std::size_t{candidates_.back().id} + 1);
    pieces_.reserve(pieces(scale) + candidates_.size());
    for (const Candidate& c : candidates_) {
      const auto times = static_cast<std::size_t>(scale * c.priority);
      if (times == 0) continue;
      is_split[c.id] = true;
      split(triangle(c.id), reader_.of_primitive(c.id), times);
    }
    references_.remove_if([&](const CodedItem& item) {
      return item.number() < is_split.size() && is_split[item.number()];
    });
    references_.store(std::move(pieces_));
  }

 private:
  [[nodiscard]] Triangle triangle(PrimitiveId id) const {
    return *references_.primitives->triangle(id);
  }

  void consider(PrimitiveId id) {
    const Reference r = reader_.of_primitive(id);
    if (!r.is_triangle()) return;
    const float importance = std::ldexp(1.0F, -grid_.level(r.box));
    const float size = area_(r.box);
    if (size * importance < least_) return;
    const Triangle t = triangle(id);
    const float waste = size - kUseful * area_.of_triangle(t.a, t.b, t.c);
    if (waste * importance >= least_)
      candidates_.push_back({.id = id, .priority = fourth_root(waste * importance)});
  }

  std::size_t pieces(float scale) const {
    std::size_t sum = 0;
    for (const Candidate& c : candidates_) sum += static_cast<std::size_t>(scale * c.priority);
    return sum;
  }

  // Returns the largest scale up to `most` for which the number of pieces is within the budget.
  float within_budget(float most) const {
    const std::size_t budget = most_pieces(references_.items.size());
    if (pieces(most) <= budget) return most;
    float low = 0, high = most;
    for (int i = 0; i < 20; ++i) {
      const float middle = (low + high) / 2;
      (pieces(middle) <= budget ? low : high) = middle;
    }
    return low;
  }

  // Splits a part of a triangle `times` times. The larger half gets more of the remaining splits.
  void split(const Triangle& t, const Reference& whole, std::size_t times) {
    const int axis = longest_axis(whole.box);
    const float plane = grid_.plane(whole.box, axis);
    if (times == 0 || !(plane > whole.box.lo[axis] && plane < whole.box.hi[axis])) {
      pieces_.push_back(whole);
      return;
    }
    const auto [left, right] = cut(t, whole.box, axis, plane);
    const float a = half_extent(left)[longest_axis(left)],
                b = half_extent(right)[longest_axis(right)];
    const auto to_left =
        static_cast<std::size_t>(std::floor(static_cast<float>(times - 1) * (a / (a + b)) + 0.5F));
    split(t, Reference(left, whole.id(), whole.weight()), to_left);
    split(t, Reference(right, whole.id(), whole.weight()), times - 1 - to_left);
  }

  References& references_;
  ReferenceReader reader_;
  Grid grid_;
  AreaMeasure area_;
  float least_;
  std::vector<Candidate> candidates_;
  PageVector<Reference> pieces_;
};

}  // namespace

std::array<Box, 2> cut(const Triangle& t, const Box& box, int axis, float plane) {
  std::array<Box, 2> parts;
  const std::array<Vec3, 3> corners{t.a, t.b, t.c};
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 &p = corners[i], &q = corners[(i + 1) % 3];
    const Box corner = box_of(Triangle{p, p, p});
    if (p[axis] <= plane) parts[0].include(corner);
    if (p[axis] >= plane) parts[1].include(corner);
    if (!(std::min(p[axis], q[axis]) < plane && plane < std::max(p[axis], q[axis]))) continue;
    const double share = (double{plane} - p[axis]) / (double{q[axis]} - p[axis]);
    const DVec3 crossing = DVec3(p) + share * (DVec3(q) - DVec3(p));
    const Box point = around(crossing, glm::abs(DVec3(p)) + glm::abs(DVec3(q)));
    for (Box& part : parts) part.include(point);
  }
  for (Box& part : parts) {
    part.lo = max(part.lo, box.lo);
    part.hi = min(part.hi, box.hi);
  }
  parts[0].hi[axis] = std::min(parts[0].hi[axis], plane);
  parts[1].lo[axis] = std::max(parts[1].lo[axis], plane);
  return parts;
}

void presplit(References& references) {
  Splitter(references).split_all();
}

}  // namespace microtrace::build
