#include "accel/build/references/duplicates.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>
#include <span>
#include <tuple>

namespace microtrace {
namespace {

using Corner = std::array<std::uint32_t, 3>;

/// A triangle's vertices in ascending order of their bits. If only two of them are distinct, the
/// lesser one comes twice, so the result does not depend on which vertex is repeated.
using Corners = std::array<Corner, 3>;

Corners corners_of(const Triangle& t) {
  const auto bits = [](const Vec3& p) {
    const Vec3 q = p + 0.0F;  // -0 becomes 0
    return std::bit_cast<Corner>(q);
  };
  Corners corners{bits(t.a), bits(t.b), bits(t.c)};
  std::ranges::sort(corners);
  if (corners[1] == corners[2]) corners[1] = corners[0];
  return corners;
}

// Hashes three numbers with the multipliers and shifts of SplitMix64 (Steele, Lea, Flood: Fast
// splittable pseudorandom number generators, 2014).
std::uint64_t hash_of(const Vec3& p) {
  const auto [x, y, z] = std::bit_cast<Corner>(p + 0.0F);  // -0 becomes 0
  const std::uint64_t xy = (std::uint64_t{x} << 32U | y) * 0xBF58476D1CE4E5B9U;
  const std::uint64_t hash = ((xy ^ xy >> 27U) + z) * 0x94D049BB133111EBU;
  return hash ^ hash >> 31U;
}

// Hashes the set of vertices, independent of their order.
std::uint64_t hash_of(const Triangle& t) {
  std::uint64_t sum = hash_of(t.a);
  if (t.b != t.a) sum += hash_of(t.b);
  if (t.c != t.a && t.c != t.b) sum += hash_of(t.c);
  return sum;
}

// Calls f(begin, end) for each range of several items with the same code, which duplicates have.
template <class F>
void for_each_range_of_a_code(const PageVector<build::CodedItem>& items, const F& f) {
  for (std::size_t begin = 0; begin < items.size();) {
    std::size_t end = begin + 1;
    while (end < items.size() && items[end].code() == items[begin].code()) ++end;
    if (end - begin > 1) f(begin, end);
    begin = end;
  }
}

}  // namespace

Duplicates::Duplicates(build::References& references) {
  std::vector<Entry> entries;
  build::ShapeReader shapes(*references.primitives);
  for_each_range_of_a_code(references.items, [&](std::size_t begin, std::size_t end) {
    entries.clear();
    for (std::size_t i = begin; i < end; ++i) {
      const PrimitiveId id = references.items[i].number();
      if (const auto triangle = shapes.triangle(id))
        entries.push_back({.hash = hash_of(*triangle), .id = id});
    }
    std::ranges::sort(entries, [](const Entry& a, const Entry& b) {
      return std::tie(a.hash, a.id) < std::tie(b.hash, b.id);
    });
    for (std::size_t first = 0; first < entries.size();) {
      std::size_t last = first + 1;
      while (last < entries.size() && entries[last].hash == entries[first].hash) ++last;
      if (last - first > 1)
        add_group(std::span(entries).subspan(first, last - first), *references.primitives);
      first = last;
    }
  });
  if (ids_.empty()) return;
  std::ranges::sort(groups_, {}, &Group::least);
  representatives_.resize(std::size_t{*std::ranges::max_element(ids_)} + 1);
  std::iota(representatives_.begin(), representatives_.end(), PrimitiveId{0});
  for (const Group& group : groups_) {
    for (std::size_t i = group.first; i < group.end; ++i) representatives_[ids_[i]] = group.least;
  }
  const auto is_removed = [this](PrimitiveId id) { return representative(id) != id; };
  references.remove_if([&](const build::CodedItem& item) { return is_removed(item.number()); });
  std::erase_if(references.large, is_removed);
}

void Duplicates::add_group(std::span<const Entry> entries, const Primitives& primitives) {
  const Corners corners = corners_of(*primitives.triangle(entries[0].id));
  const std::size_t first = ids_.size();
  for (const Entry& entry : entries.subspan(1)) {
    if (corners_of(*primitives.triangle(entry.id)) == corners) ids_.push_back(entry.id);
  }
  if (ids_.size() > first)
    groups_.push_back({.least = entries[0].id, .first = first, .end = ids_.size()});
}

std::optional<PrimitiveId> Duplicates::above(PrimitiveId id, PrimitiveId after) const {
  if (id > after) return id;
  const auto group = std::ranges::lower_bound(groups_, id, {}, &Group::least);
  if (group == groups_.end() || group->least != id) return std::nullopt;
  const auto duplicates = std::span(ids_).subspan(group->first, group->end - group->first);
  const auto next = std::ranges::upper_bound(duplicates, after);
  return next != duplicates.end() ? std::optional(*next) : std::nullopt;
}

std::size_t Duplicates::memory() const {
  const auto bytes = [](const auto& list) { return list.size() * sizeof list[0]; };
  return bytes(ids_) + bytes(groups_) + bytes(representatives_);
}

}  // namespace microtrace
