#include "accel/build/references/reference.hpp"

#include "accel/build/area.hpp"
#include "accel/build/references/presplit.hpp"
#include "accel/build/references/shape_box.hpp"

#include <microtrace/error.hpp>

#include <array>

namespace microtrace::build {
namespace {

// The maximum total weight (see kTriangleWeight) that leaf references can address, with room for
// split triangles.
constexpr std::uint64_t kMostWeight = std::uint64_t{1} << 30U;

// Hashes three numbers with the multipliers and shifts of SplitMix64 (Steele, Lea, Flood: Fast
// splittable pseudorandom number generators, 2014).
std::uint64_t hash_of(const Vec3& p) {
  const auto [x, y, z] = std::bit_cast<std::array<std::uint32_t, 3>>(p + 0.0F);  // -0 becomes 0
  const std::uint64_t xy = (std::uint64_t{x} << 32U | y) * 0xBF58476D1CE4E5B9U;
  const std::uint64_t hash = ((xy ^ xy >> 27U) + z) * 0x94D049BB133111EBU;
  return hash ^ hash >> 31U;
}

// Hashes the set of vertices, independent of their order.
std::uint32_t hash_of(const Triangle& t) {
  std::uint64_t sum = hash_of(t.a);
  if (t.b != t.a) sum += hash_of(t.b);
  if (t.c != t.a && t.c != t.b) sum += hash_of(t.c);
  return static_cast<std::uint32_t>(sum >> 32U);
}

class Gatherer {
 public:
  explicit Gatherer(References& to) : to_(to) {}

  void operator()(PrimitiveId id, const Triangle& t) {
    if (is_empty(t)) return;
    const Box box = box_of(t);
    add(box, id, fits_blocks(box) ? kTriangleWeight : kOtherWeight, hash_of(t));
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

  void add(const Box& box, PrimitiveId id, std::uint32_t weight, std::uint32_t hash) {
    to_.bounded.emplace_back(box, id, weight);
    to_.hashes.push_back(hash);
    to_.area += half_area(double{box.hi[0]} - box.lo[0], double{box.hi[1]} - box.lo[1],
                          double{box.hi[2]} - box.lo[2]);
  }

  References& to_;
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
  for (std::size_t i = 0; i < objects.size(); ++i)
    if (!is_instance[i]) primitives.for_each_of(i, Gatherer(references));
  std::uint64_t weight = 0;
  for (const Reference& r : references.bounded) weight += r.weight();
  if (weight > kMostWeight)
    throw Error(ErrorKind::limit, "", "the scene has more than 2^30 triangles; leave some out");
  return references;
}

void set_points_apart(PageVector<Reference>& references) {
  for (Reference& r : references) {
    if (r.weight() == kTriangleWeight && is_point(r.box))
      r = Reference(r.box, r.id(), kOtherWeight);
  }
}

}  // namespace microtrace::build
