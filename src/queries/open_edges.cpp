#include "queries/open_edges.hpp"

#include "exact/range.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>

namespace microtrace {
namespace {

/// Assigns numbers to vertices; vertices at equal positions get the same number.
class Vertices {
 public:
  explicit Vertices(std::size_t most) : table_(std::bit_ceil(2 * most + 1), kFree) {}

  [[nodiscard]] std::uint32_t number(const Vec3& p) {
    const std::size_t mask = table_.size() - 1;
    std::size_t slot = hash(p) & mask;
    while (table_[slot] != kFree && positions_[table_[slot]] != p) slot = (slot + 1) & mask;
    if (table_[slot] == kFree) {
      table_[slot] = static_cast<std::uint32_t>(positions_.size());
      positions_.push_back(p);
    }
    return table_[slot];
  }
  [[nodiscard]] const Vec3& operator[](std::uint32_t number) const { return positions_[number]; }

 private:
  static constexpr std::uint32_t kFree = ~std::uint32_t{0};

  /// Gives -0 and 0 the same hash.
  static std::size_t hash(const Vec3& p) {
    std::uint64_t hash = 0;
    for (int k = 0; k < 3; ++k) {
      hash = (hash ^ std::bit_cast<std::uint32_t>(p[k] + 0.0F)) * 0x9E3779B97F4A7C15ULL;
      hash ^= hash >> 32U;
    }
    return static_cast<std::size_t>(hash);
  }

  std::vector<std::uint32_t> table_;  // a hash table with linear probing, at most half full
  std::vector<Vec3> positions_;
};

/// One side of a triangle.
struct Side {
  std::uint32_t lesser, greater;  // numbers of its vertices
  PrimitiveId triangle;
  std::uint32_t index;
};

}  // namespace

std::vector<OpenEdge> open_edges(const Primitives& primitives, Selection selection) {
  const Scene& scene = primitives.scene();
  std::size_t most_vertices = 0, most_sides = 0;
  const auto for_each_object = [&](const auto& f) {
    for (const ObjectRun& run : scene.objects.runs()) {
      for (std::size_t i = run.begin; i < run.begin + run.count; ++i)
        if (selection.contains(primitives.first_id_of(i))) std::visit(f, run.first->shape);
    }
  };
  for_each_object([&]<class AnyShape>(const AnyShape& shape) {
    if constexpr (std::is_same_v<AnyShape, Mesh>) {
      most_vertices += std::min(shape.positions.size(), 3 * shape.triangles.size());
      most_sides += 3 * shape.triangles.size();
    } else {
      most_vertices += 3, most_sides += 3;
    }
  });
  Vertices vertices(most_vertices);
  std::vector<Side> sides;
  sides.reserve(most_sides);
  for (std::uint64_t number = selection.first; number < selection.end; ++number) {
    const auto id = static_cast<PrimitiveId>(number);
    const auto t = primitives.triangle(id);
    if (!t || !is_finite(t->a) || !is_finite(t->b) || !is_finite(t->c)) continue;
    const std::array<std::uint32_t, 3> corners{vertices.number(t->a), vertices.number(t->b),
                                               vertices.number(t->c)};
    for (std::uint32_t i = 0; i < 3; ++i) {
      const auto [lesser, greater] = std::minmax(corners[i], corners[(i + 1) % 3]);
      if (lesser != greater)
        sides.push_back({.lesser = lesser, .greater = greater, .triangle = id, .index = i});
    }
  }
  std::ranges::sort(sides, [](const Side& a, const Side& b) {
    return std::tie(a.lesser, a.greater, a.triangle, a.index) <
           std::tie(b.lesser, b.greater, b.triangle, b.index);
  });
  std::vector<OpenEdge> open;
  for (std::size_t i = 0, end = 0; i < sides.size(); i = end) {
    const Side& side = sides[i];
    while (end < sides.size() && sides[end].lesser == side.lesser &&
           sides[end].greater == side.greater)
      ++end;
    if ((end - i) % 2 == 0) continue;
    const Triangle t = *primitives.triangle(side.triangle);
    const std::array<Vec3, 3> corners{t.a, t.b, t.c};
    open.push_back({.triangle = side.triangle,
                    .side = side.index,
                    .count = static_cast<std::uint32_t>(end - i),
                    .a = DVec3(corners[side.index]),
                    .b = DVec3(corners[(side.index + 1) % 3])});
  }
  std::ranges::sort(open, [](const OpenEdge& a, const OpenEdge& b) {
    return std::tie(a.triangle, a.side) < std::tie(b.triangle, b.side);
  });
  return open;
}

}  // namespace microtrace
