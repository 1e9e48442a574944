#include "accel/build/reference.hpp"

#include "accel/build/shape_box.hpp"

#include <microtrace/error.hpp>

namespace microtrace::build {
namespace {

// That many eighths of a block have a place in a leaf's reference, with room for split triangles.
constexpr std::uint64_t kMostWeight = std::uint64_t{1} << 30U;

bool fits_blocks(const Box& b) {
  const Float4 size = max(max(b.hi, -b.hi), max(b.lo, -b.lo));
  return size[0] <= kLargestInBlocks && size[1] <= kLargestInBlocks && size[2] <= kLargestInBlocks;
}

class Gatherer {
 public:
  explicit Gatherer(References& to) : to_(to) {}

  void operator()(PrimitiveId id, const Triangle& t) {
    if (is_empty(t)) return;
    const Box box = box_of(t);
    to_.bounded.emplace_back(box, id, fits_blocks(box) ? kTriangleWeight : kOtherWeight);
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
    if (is_finite(box))
      to_.bounded.emplace_back(box, id, kOtherWeight);
    else
      to_.unbounded.push_back(id);
  }

  References& to_;
};

}  // namespace

References gather(const Primitives& primitives) {
  References references;
  std::size_t count = 0;
  primitives.for_each([&](PrimitiveId, const auto&) { ++count; });
  references.bounded.reserve(count);
  primitives.for_each(Gatherer(references));
  std::uint64_t weight = 0;
  for (const Reference& r : references.bounded) weight += r.weight();
  if (weight > kMostWeight)
    throw Error(ErrorKind::limit, "", "the scene has more than 2^30 triangles; leave some out");
  return references;
}

}  // namespace microtrace::build
