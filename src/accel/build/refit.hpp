#pragma once
/// Fits a tree to new positions of its primitives, several times faster than building one: I. Wald,
/// S. Boulos, P. Shirley, Ray tracing deformable scenes using dynamic bounding volume hierarchies,
/// 2007, section 3.

#include "accel/build/references/reference.hpp"
#include "accel/build/tree.hpp"
#include "accel/build/worker_pool.hpp"

#include <microtrace/primitives.hpp>

#include <optional>

namespace microtrace::build {

/// Fits the previous tree to the primitives' new shapes, without `duplicates` and `unbounded`. The
/// box of a triangle that moved contains the whole triangle, even if the tree was built with boxes
/// of its pieces. A leaf in which nothing moved keeps its box.
///
/// `references` are those of all primitives that belong in a tree. Returns nothing if the previous
/// tree has other primitives, if it has one of them in another kind of leaf than a new tree would,
/// or if a relative cost would exceed max_growth times its value when the tree was built.
[[nodiscard]] std::optional<Tree> refitted(const Tree& previous, const References& references,
                                           const Primitives& primitives, double max_growth,
                                           WorkerPool& pool);

[[nodiscard]] RelativeCost relative_cost(const Tree& tree);

}  // namespace microtrace::build
