#include "accel/bundle.hpp"

#include <microtrace/intersector.hpp>

#include <algorithm>
#include <cassert>

namespace microtrace {
namespace {

// How many rays from the front can make a bundle: valid and with the first one's origin.
std::size_t bundle_length(std::span<const Ray> rays) {
  const auto belongs = [&](const Ray& ray) { return ray.o == rays[0].o && exact::is_valid(ray); };
  const auto front = rays.first(std::min(rays.size(), Bundle::kCapacity));
  return static_cast<std::size_t>(std::find_if_not(front.begin(), front.end(), belongs) -
                                  front.begin());
}

}  // namespace

void Intersector::intersect(std::span<const Ray> rays, std::span<std::optional<Hit>> hits) const {
  assert(rays.size() == hits.size());
  while (!rays.empty()) {
    const std::size_t length = bundle_length(rays);
    if (length > 0) {
      Bundle bundle(primitives_, rays.first(length));
      primitives_.for_each([&](PrimitiveId id, const auto& shape) { bundle.meet(id, shape); });
      for (std::size_t i = 0; i < length; ++i) hits[i] = bundle.hit(i);
    } else {
      hits[0].reset();  // not a valid ray
    }
    const std::size_t done = std::max<std::size_t>(length, 1);
    rays = rays.subspan(done);
    hits = hits.subspan(done);
  }
}

std::optional<Hit> Intersector::intersect(const Ray& ray) const {
  std::optional<Hit> hit;
  intersect(std::span(&ray, 1), std::span(&hit, 1));
  return hit;
}

}  // namespace microtrace
