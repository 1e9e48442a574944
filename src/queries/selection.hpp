#pragma once
#include "queries/duplicates.hpp"

#include <microtrace/hit.hpp>

#include <cstdint>
#include <optional>

namespace microtrace {

/// The primitives that a query considers, with ids from first to end - 1.
struct Selection {
  std::uint64_t first, end;

  [[nodiscard]] bool contains(PrimitiveId id) const { return id >= first && id < end; }

  /// Returns the number of selected primitives among a primitive of the tree and its duplicates.
  [[nodiscard]] std::uint64_t count(const Duplicates& duplicates, PrimitiveId id) const {
    std::uint64_t count = 0;
    for_each_duplicate(duplicates, id, [&](PrimitiveId k) { count += contains(k) ? 1 : 0; });
    return count;
  }

  /// Returns the lowest selected id among a primitive of the tree and its duplicates.
  [[nodiscard]] std::optional<PrimitiveId> least(const Duplicates& duplicates,
                                                 PrimitiveId id) const {
    if (contains(id)) return id;
    if (first == 0 || duplicates.empty()) return std::nullopt;
    const auto next = duplicates.above(id, static_cast<PrimitiveId>(first - 1));
    return next && contains(*next) ? next : std::nullopt;
  }
};

}  // namespace microtrace
