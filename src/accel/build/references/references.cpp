#include "accel/build/references/references.hpp"

#include "accel/build/area.hpp"
#include "accel/build/references/presplit.hpp"

#include <microtrace/error.hpp>

#include <algorithm>
#include <array>
#include <utility>

namespace microtrace::build {
namespace {

// The maximum total weight (see kTriangleWeight) that leaf references can address, with room for
// split triangles.
constexpr std::uint64_t kMostWeight = std::uint64_t{1} << 31U;

double half_area_of(const Box& b) {
  return half_area(double{b.hi[0]} - b.lo[0], double{b.hi[1]} - b.lo[1], double{b.hi[2]} - b.lo[2]);
}

// Estimates from a sample of the vertices how many triangles share one.
class Sharing {
 public:
  explicit Sharing(std::size_t triangles) : mask_(std::bit_ceil(triangles / kSamples + 1) - 1) {}

  void add(const Triangle& t) {
    for (const Vec3& vertex : {t.a, t.b, t.c}) {
      const auto [x, y, z] = std::bit_cast<Vertex>(vertex);
      const std::uint32_t mixed = (x * 0x9E3779B1U ^ y * 0x85EBCA77U ^ z) * 0xC2B2AE3DU;
      if ((mixed >> 8U & mask_) == 0 && sample_.size() < 16 * kSamples)
        sample_.push_back({x, y, z});
    }
  }
  // True if eight triangles would mostly have too many vertices for a block.
  [[nodiscard]] bool is_rare() {
    const std::size_t uses = sample_.size();
    std::ranges::sort(sample_);
    sample_.erase(std::unique(sample_.begin(), sample_.end()), sample_.end());
    return 4 * uses < 5 * sample_.size();
  }

 private:
  static constexpr std::size_t kSamples = 4096;
  using Vertex = std::array<std::uint32_t, 3>;

  std::uint64_t mask_;
  std::vector<Vertex> sample_;  // one for each use of a vertex
};

class Gatherer {
 public:
  Gatherer(References& to, Sharing& sharing) : to_(to), sharing_(sharing) {}

  void operator()(PrimitiveId id, const Triangle& t) {
    if (is_empty(t)) return;
    const Box box = box_of(t);
    add(box, id);
    if (!fits_blocks(box) || is_point(box)) ++others_;
    sharing_.add(t);
  }
  void operator()(PrimitiveId id, const Sphere& s) { add_curved(id, s); }
  void operator()(PrimitiveId id, const Disc& d) { add_curved(id, d); }
  void operator()(PrimitiveId id, const Plane& p) {
    if (!is_empty(p)) to_.unbounded.push_back(id);
  }
  void operator()(PrimitiveId id, const Quadric& q) { add_curved(id, q); }

  [[nodiscard]] std::uint64_t others() const { return others_; }

  // Lists the primitives that are large compared with the box of all.
  void list_large() {
    const double least =
        kLeastSplit * half_area_of(to_.box) / static_cast<double>(to_.items.size());
    ReferenceReader reader(to_);
    for (std::size_t run = 0; run < largest_.size(); ++run) {
      if (largest_[run] < least) continue;
      const std::size_t end = std::min((run + 1) * kRun, to_.items.size());
      for (std::size_t i = run * kRun; i < end; ++i)
        if (half_area_of(reader(to_.items, i).box) >= least)
          to_.large.push_back(to_.items[i].number());
    }
  }

 private:
  static constexpr std::size_t kRun = 1024;

  template <class S>
  void add_curved(PrimitiveId id, const S& shape) {
    if (is_empty(shape)) return;
    const Box box = box_of(shape);
    if (is_finite(box)) {
      add(box, id);
      ++others_;
    } else {
      to_.unbounded.push_back(id);
    }
  }

  void add(const Box& box, PrimitiveId id) {
    to_.box.include(box);
    const double area = half_area_of(box);
    to_.area += area;
    if (to_.items.size() % kRun == 0) largest_.push_back(0);
    largest_.back() = std::max(largest_.back(), area);
    to_.items.emplace_back(false, id);
  }

  References& to_;
  Sharing& sharing_;
  std::vector<double> largest_;  // the greatest area of each run of kRun items
  std::uint64_t others_ = 0;     // number of primitives that are not stored in blocks
};

}  // namespace

References gather(const Primitives& primitives, const std::vector<bool>& is_instance) {
  References references{.primitives = &primitives};
  const Objects& objects = primitives.scene().objects;
  std::size_t count = 0;
  const auto for_each_other = [&](const auto& f) {
    for (const ObjectRun& run : objects.runs())
      for (std::size_t i = 0; i < run.count; ++i)
        if (!is_instance[run.begin + i]) f(run, i);
  };
  for_each_other(
      [&](const ObjectRun& run, std::size_t) { count += primitive_count(run.first->shape); });
  references.items.reserve(count);
  Sharing sharing(count);
  Gatherer gatherer(references, sharing);
  for_each_other(
      [&](const ObjectRun& run, std::size_t i) { primitives.for_each_of(run, i, gatherer); });
  gatherer.list_large();
  if (sharing.is_rare()) references.triangle_weight = kUnsharedWeight;
  const std::uint64_t triangles = references.items.size() - gatherer.others();
  if (triangles * references.triangle_weight + gatherer.others() * kOtherWeight > kMostWeight)
    throw Error(ErrorKind::limit, "", "the scene has more than 2^30 triangles; leave some out");
  return references;
}

void References::store(PageVector<Reference> references) {
  if (references.empty()) return;
  const std::size_t first = stored.size();
  if (stored.empty())
    stored = std::move(references);
  else
    stored.insert(stored.end(), references.begin(), references.end());
  items.reserve(items.size() + stored.size() - first);
  for (std::size_t i = first; i < stored.size(); ++i) {
    items.emplace_back(true, static_cast<std::uint32_t>(i));
    box.include(stored[i].box);
  }
  cells.clear();
}

void References::order_stored() {
  PageVector<Reference> ordered;
  ordered.reserve(stored.size());
  for (CodedItem& item : items) {
    if (!item.is_stored()) continue;
    const auto number = static_cast<std::uint32_t>(ordered.size());
    ordered.push_back(stored[item.number()]);
    item.set_number(number);
  }
  stored = std::move(ordered);
}

}  // namespace microtrace::build
