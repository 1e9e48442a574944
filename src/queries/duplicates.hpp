#pragma once
#include "accel/build/references/duplicates.hpp"

namespace microtrace {

/// Calls f(id) for a primitive of the tree and for all its duplicates (see
/// accel/build/references/duplicates.hpp), in ascending order.
template <class F>
void for_each_duplicate(const Duplicates& duplicates, PrimitiveId id, const F& f) {
  f(id);
  if (duplicates.empty()) return;
  for (auto next = duplicates.above(id, id); next; next = duplicates.above(id, *next)) f(*next);
}

}  // namespace microtrace
