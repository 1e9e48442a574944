#include "accel/build/references/reference.hpp"

#include "accel/build/area.hpp"
#include "accel/build/references/presplit.hpp"
#include "accel/build/references/shape_box.hpp"

#include <microtrace/error.hpp>

#include <algorithm>
#include <array>

namespace microtrace::build {
namespace {

// The maximum total weight (see kTriangleWeight) that leaf references can address, with room for
// split triangles.
constexpr std::uint64_t kMostWeight = std::uint64_t{1} << 31U;

// Hashes three numbers with the multipliers and shifts of SplitMix64 (Steele, Lea, Flood: Fast
// splittable pseudorandom number generators, 2014).
std::uint64_t hash_of(const Vec3& p) {
  const auto [x, y, z] = std::bit_cast<std::array<std::uint32_t, 3>>(p + 0.0F);  // -0 becomes 0
  const std::uint64_t xy = (std::uint64_t{x} << 32U | y) * 0xBF58476D1CE4E5B9U;
  const std::uint64_t hash = ((xy ^ xy >> 27U) + z) * 0x94D049BB133111EBU;
  return hash ^ hash >> 31U;
}

// Estimates from a sample of the vertices how many triangles share one.
class Sharing {
 public:
  explicit Sharing(std::size_t triangles) : mask_(std::bit_ceil(triangles / kSamples + 1) - 1) {}

  void add(std::uint64_t hash) {
    if ((hash & mask_) == 0 && hashes_.size() < 16 * kSamples) hashes_.push_back(hash);
  }
  // True if eight triangles would mostly have too many vertices for a block.
  [[nodiscard]] bool is_rare() {
    const std::size_t uses = hashes_.size();
    std::ranges::sort(hashes_);
    hashes_.erase(std::unique(hashes_.begin(), hashes_.end()), hashes_.end());
    return 4 * uses < 5 * hashes_.size();
  }

 private:
  static constexpr std::size_t kSamples = 4096;

  std::uint64_t mask_;
  std::vector<std::uint64_t> hashes_;  // one for each use of a vertex of the sample
};

class Gatherer {
 public:
  Gatherer(References& to, Sharing& sharing) : to_(to), sharing_(sharing) {}

  void operator()(PrimitiveId id, const Triangle& t) {
    if (is_empty(t)) return;
    const Box box = box_of(t);
    add(box, id, fits_blocks(box) ? kTriangleWeight : kOtherWeight, hash(t));
  }
  void operator()(PrimitiveId id, const Sphere& s) { add_curved(id, s); }
  void operator()(PrimitiveId id, const Disc& d) { add_curved(id, d); }
  void operator()(PrimitiveId id, const Plane& p) {
    if (!is_empty(p)) to_.unbounded.push_back(id);
  }
  void operator()(PrimitiveId id, const Quadric& q) {
    if (!is_empty(q)) to_.unbounded.push_back(id);
  }

 private:
  template <class S>
  void add_curved(PrimitiveId id, const S& shape) {
    if (is_empty(shape)) return;
    const Box box = box_of(shape);
    if (is_finite(box)) {
      add(box, id, kOtherWeight, id);
    } else {
      to_.unbounded.push_back(id);
    }
  }

  // Hashes the set of vertices, independent of their order.
  std::uint32_t hash(const Triangle& t) {
    std::uint64_t sum = 0;
    const auto add = [&](const Vec3& vertex) {
      const std::uint64_t hash = hash_of(vertex);
      sharing_.add(hash);
      sum += hash;
    };
    add(t.a);
    if (t.b != t.a) add(t.b);
    if (t.c != t.a && t.c != t.b) add(t.c);
    return static_cast<std::uint32_t>(sum >> 32U);
  }

  void add(const Box& box, PrimitiveId id, std::uint32_t weight, std::uint32_t hash) {
    to_.bounded.emplace_back(box, id, weight);
    to_.hashes.push_back(hash);
    to_.area += half_area(double{box.hi[0]} - box.lo[0], double{box.hi[1]} - box.lo[1],
                          double{box.hi[2]} - box.lo[2]);
  }

  References& to_;
  Sharing& sharing_;
};

}  // namespace

bool fits_blocks(const Box& b) {
  const Float4 size = max(max(b.hi, -b.hi), max(b.lo, -b.lo));
  return size[0] <= kLargestInBlocks && size[1] <= kLargestInBlocks && size[2] <= kLargestInBlocks;
}

References gather(const Primitives& primitives, const std::vector<bool>& is_instance) {
  References references;
  const std::vector<Object>& objects = primitives.scene().objects;
  std::size_t count = 0;
  for (std::size_t i = 0; i < objects.size(); ++i)
    if (!is_instance[i]) count += primitive_count(objects[i].shape);
  // Pages that no pieces are written to take no memory.
  references.bounded.reserve(count + most_pieces(count));
  references.hashes.reserve(count);
  Sharing sharing(count);
  for (std::size_t i = 0; i < objects.size(); ++i)
    if (!is_instance[i]) primitives.for_each_of(i, Gatherer(references, sharing));
  if (sharing.is_rare()) {
    references.triangle_weight = kUnsharedWeight;
    for (Reference& r : references.bounded)
      if (r.is_triangle()) r = Reference(r.box, r.id(), kUnsharedWeight);
  }
  std::uint64_t weight = 0;
  for (const Reference& r : references.bounded) weight += r.weight();
  if (weight > kMostWeight)
    throw Error(ErrorKind::limit, "", "the scene has more than 2^30 triangles; leave some out");
  return references;
}

void set_points_apart(PageVector<Reference>& references) {
  for (Reference& r : references) {
    if (r.is_triangle() && is_point(r.box)) r = Reference(r.box, r.id(), kOtherWeight);
  }
}

}  // namespace microtrace::build
