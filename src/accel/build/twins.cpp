#include "accel/build/twins.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <tuple>

namespace microtrace {
namespace {

using build::Reference;

/// The corners in an order that does not depend on where the triangle begins and how it turns.
using Corners = std::array<std::array<std::uint32_t, 3>, 3>;

Corners corners_of(const Triangle& t) {
  const auto bits = [](const Vec3& p) {
    return std::array{std::bit_cast<std::uint32_t>(p.x), std::bit_cast<std::uint32_t>(p.y),
                      std::bit_cast<std::uint32_t>(p.z)};
  };
  Corners corners{bits(t.a), bits(t.b), bits(t.c)};
  std::ranges::sort(corners);
  return corners;
}

std::uint64_t hash_of(const Corners& corners) {
  std::uint64_t hash = 0;
  for (const auto& corner : corners) {
    for (const std::uint32_t number : corner) {
      hash = (hash ^ number) * 0x9E3779B97F4A7C15U;
      hash ^= hash >> 29U;
    }
  }
  return hash;
}

bool is_triangle(const Reference& reference) {
  return reference.weight() == build::kTriangleWeight;
}

Corners corners_of(const Reference& reference, const Primitives& primitives) {
  return primitives.visit(reference.id(), [](const auto& shape) {
    if constexpr (std::is_same_v<std::decay_t<decltype(shape)>, Triangle>) {
      return corners_of(shape);
    } else {
      return Corners{};
    }
  });
}

/// By their boxes, a sample of them.
bool are_many(const PageVector<Reference>& references) {
  constexpr std::size_t most = 4096;
  const std::size_t step = references.size() / most + 1;
  std::vector<std::array<float, 6>> boxes;
  for (std::size_t i = 0; i < references.size(); i += step) {
    const build::Box& b = references[i].box;
    if (is_triangle(references[i]))
      boxes.push_back({b.lo[0], b.lo[1], b.lo[2], b.hi[0], b.hi[1], b.hi[2]});
  }
  std::ranges::sort(boxes);
  // The halves of a rectangle have one box.
  for (std::size_t i = 2; i < boxes.size(); ++i) {
    if (boxes[i] == boxes[i - 2]) return true;
  }
  return false;
}

}  // namespace

Twins::Twins(PageVector<Reference>& references, const Primitives& primitives) {
  if (!are_many(references)) return;
  struct Entry {
    std::uint64_t hash;
    PrimitiveId id;
    std::uint32_t place;
  };
  std::vector<Entry> entries;
  for (std::size_t i = 0; i < references.size(); ++i) {
    if (!is_triangle(references[i])) continue;
    entries.push_back({.hash = hash_of(corners_of(references[i], primitives)),
                       .id = references[i].id(),
                       .place = static_cast<std::uint32_t>(i)});
  }
  std::ranges::sort(entries, [](const Entry& a, const Entry& b) {
    return std::tie(a.hash, a.id) < std::tie(b.hash, b.id);
  });
  std::vector<bool> is_twin(references.size());
  for (std::size_t i = 0; i < entries.size();) {
    const Entry& least = entries[i];
    const Corners corners = corners_of(references[least.place], primitives);
    const std::size_t first = ids_.size();
    std::size_t end = i + 1;
    for (; end < entries.size() && entries[end].hash == least.hash; ++end) {
      if (corners_of(references[entries[end].place], primitives) != corners) continue;
      ids_.push_back(entries[end].id);
      is_twin[entries[end].place] = true;
    }
    if (ids_.size() > first) groups_[least.id] = {first, ids_.size()};
    i = end;
  }
  std::size_t left = 0;
  for (std::size_t i = 0; i < references.size(); ++i) {
    if (!is_twin[i]) references[left++] = references[i];
  }
  references.resize(left);
}

std::optional<PrimitiveId> Twins::above(PrimitiveId id, PrimitiveId after) const {
  if (id > after) return id;
  const auto group = groups_.find(id);
  if (group == groups_.end()) return std::nullopt;
  const auto begin = ids_.begin() + static_cast<std::ptrdiff_t>(group->second.first);
  const auto end = ids_.begin() + static_cast<std::ptrdiff_t>(group->second.second);
  const auto next = std::upper_bound(begin, end, after);
  return next != end ? std::optional(*next) : std::nullopt;
}

bool Twins::stands_for(PrimitiveId id, PrimitiveId other) const {
  if (id == other) return true;
  const auto group = groups_.find(id);
  if (group == groups_.end()) return false;
  const auto begin = ids_.begin() + static_cast<std::ptrdiff_t>(group->second.first);
  const auto end = ids_.begin() + static_cast<std::ptrdiff_t>(group->second.second);
  return std::binary_search(begin, end, other);
}

}  // namespace microtrace
