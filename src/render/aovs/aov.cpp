#include "render/aovs/aov_value.hpp"
#include "render/surfaces.hpp"

#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

namespace microtrace {
namespace {

struct Row {
  std::string_view name;
  std::array<std::string_view, 3> channels;
  std::size_t count;
};

const Row& row_of(Aov aov) {
  // In the order of Aov.
  static constexpr std::array kRows = {Row{"depth", {"Z"}, 1},
                                       Row{"distance", {"T"}, 1},
                                       Row{"position", {"X", "Y", "Z"}, 3},
                                       Row{"normal", {"X", "Y", "Z"}, 3},
                                       Row{"face_normal", {"X", "Y", "Z"}, 3},
                                       Row{"uv", {"U", "V"}, 2},
                                       Row{"barycentric", {"X", "Y", "Z"}, 3},
                                       Row{"albedo", {"R", "G", "B"}, 3},
                                       Row{"id", {"instance", "primitive", "material"}, 3}};
  static_assert(kRows.size() == kAovs.size());
  return kRows[static_cast<std::size_t>(aov)];
}

std::array<float, 3> rounded(const DVec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

}  // namespace

std::string_view name_of(Aov aov) {
  return row_of(aov).name;
}

std::optional<Aov> aov_named(std::string_view name) {
  for (const Aov aov : kAovs) {
    if (name_of(aov) == name) return aov;
  }
  return std::nullopt;
}

std::span<const std::string_view> channels_of(Aov aov) {
  const Row& row = row_of(aov);
  return std::span(row.channels).first(row.count);
}

void find_seen(const World& world, std::span<const Ray> rays, std::span<std::optional<Hit>> hits) {
  world.bvh.intersect(rays, hits);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    hits[i] = world.first_visible(rays[i], hits[i]);
  }
}

std::array<float, 3> value_of(Aov aov, const Sight& sight) {
  const SurfaceInteraction& at = sight.at;
  const double side = at.front ? 1 : -1;
  switch (aov) {
    case Aov::depth:
      return rounded(DVec3(sight.world.camera.depth(at.p), 0, 0));
    case Aov::distance: {
      const DVec3 way = at.p - DVec3(sight.ray.o);
      return rounded(DVec3(std::sqrt(glm::dot(way, way)), 0, 0));
    }
    case Aov::position:
      return rounded(at.p + sight.world.scene.origin);
    case Aov::normal:
      return rounded(side * at.ns);
    case Aov::face_normal:
      return rounded(side * at.n);
    case Aov::uv:
      return rounded(DVec3(at.uv(0).value_or(DVec2(0)), 0));
    case Aov::barycentric:
      return rounded(at.triangle ? at.triangle->barycentrics : DVec3(0));
    case Aov::albedo:
      return rounded(DVec3(DVec4(sight.world.base_color(sight.ray, sight.hit))));
    case Aov::id:
      break;
  }
  return {};
}

std::array<float, 3> value_of_nothing(Aov aov) {
  if (aov == Aov::depth || aov == Aov::distance) return {std::numeric_limits<float>::infinity()};
  return {};
}

std::array<std::uint32_t, 3> ids_of(const World& world, const std::optional<Hit>& hit) {
  if (!hit) return {};
  const Primitives& primitives = world.bvh.primitives();
  const std::optional<std::uint32_t> material = primitives.object(hit->id).material;
  return {static_cast<std::uint32_t>(primitives.object_index(hit->id)) + 1,
          hit->id - primitives.first_id(hit->id) + 1, material ? *material + 1 : 0};
}

}  // namespace microtrace
