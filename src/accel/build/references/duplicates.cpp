#include "accel/build/references/duplicates.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>
#include <span>
#include <tuple>

namespace microtrace {
namespace {

using build::Reference;

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

/// A set of hashes whose contains() may be true for a hash that was not inserted. After B. Bloom,
/// Space/time trade-offs in hash coding with allowable errors, 1970, with one bit per hash.
class BloomFilter {
 public:
  /// Chooses the size so that contains() is wrong for at most about one in sixteen hashes outside
  /// the set.
  explicit BloomFilter(std::size_t hashes)
      : shift_(std::max(0, std::countl_zero(16 * hashes | 64) - 32)),
        words_((~std::uint32_t{0} >> shift_) / 64 + 1, 0) {}

  [[nodiscard]] bool contains(std::uint32_t hash) const {
    const std::uint32_t bit = hash >> shift_;
    return (words_[bit / 64] >> (bit % 64) & 1U) != 0;
  }
  void insert(std::uint32_t hash) {
    const std::uint32_t bit = hash >> shift_;
    words_[bit / 64] |= std::uint64_t{1} << (bit % 64);
  }

 private:
  int shift_;
  PageVector<std::uint64_t> words_;
};

/// Returns the ascending indices of all hashes that occur more than once, and of a few others. This
/// is much faster than sorting, because nearly all hashes are unique.
std::vector<std::uint32_t> repeated(const PageVector<std::uint32_t>& hashes) {
  BloomFilter once(hashes.size());
  std::vector<std::uint32_t> again;
  for (const std::uint32_t hash : hashes) {
    if (once.contains(hash)) again.push_back(hash);
    once.insert(hash);
  }
  std::vector<std::uint32_t> slots;
  if (again.empty()) return slots;
  BloomFilter twice(again.size());
  for (const std::uint32_t hash : again) twice.insert(hash);
  for (std::size_t i = 0; i < hashes.size(); ++i) {
    if (twice.contains(hashes[i])) slots.push_back(static_cast<std::uint32_t>(i));
  }
  return slots;
}

}  // namespace

Duplicates::Duplicates(build::References& from, const Primitives& primitives) {
  PageVector<Reference>& references = from.bounded;
  struct Entry {
    std::uint32_t hash;
    PrimitiveId id;
    std::uint32_t slot;
  };
  std::vector<Entry> entries;
  for (const std::uint32_t slot : repeated(from.hashes)) {
    if (primitives.triangle(references[slot].id()))
      entries.push_back({.hash = from.hashes[slot], .id = references[slot].id(), .slot = slot});
  }
  std::ranges::sort(entries, [](const Entry& a, const Entry& b) {
    return std::tie(a.hash, a.id) < std::tie(b.hash, b.id);
  });
  std::vector<bool> is_duplicate(references.size());
  for (std::size_t i = 0; i < entries.size();) {
    std::size_t end = i + 1;
    while (end < entries.size() && entries[end].hash == entries[i].hash) ++end;
    if (end - i > 1) {
      const Corners corners = corners_of(*primitives.triangle(entries[i].id));
      const std::size_t first = ids_.size();
      for (std::size_t k = i + 1; k < end; ++k) {
        if (corners_of(*primitives.triangle(entries[k].id)) != corners) continue;
        ids_.push_back(entries[k].id);
        is_duplicate[entries[k].slot] = true;
      }
      if (ids_.size() > first)
        groups_.push_back({.least = entries[i].id, .first = first, .end = ids_.size()});
    }
    i = end;
  }
  if (ids_.empty()) return;
  std::ranges::sort(groups_, {}, &Group::least);
  representatives_.resize(std::size_t{*std::ranges::max_element(ids_)} + 1);
  std::iota(representatives_.begin(), representatives_.end(), PrimitiveId{0});
  for (const Group& group : groups_) {
    for (std::size_t i = group.first; i < group.end; ++i) representatives_[ids_[i]] = group.least;
  }
  std::size_t left = 0;
  for (std::size_t i = 0; i < references.size(); ++i) {
    if (!is_duplicate[i]) references[left++] = references[i];
  }
  references.resize(left);
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
