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

/// The previous tree for the primitives' new shapes, without `duplicates` and `unbounded`. Boxes
/// contain all of a triangle that moved, even if the tree was built with boxes of its pieces; a
/// leaf in which nothing moved keeps its box.
///
/// `references` are those of all primitives that belong in a tree. Nothing if the previous tree has
/// other primitives, or has one of them in another kind of leaf than a new tree; or if a relative
/// cost would be more than max_growth times that of the tree when it was built.
[[nodiscard]] std::optional<Tree> refitted(const Tree& previous, const References& references,
                                           const Primitives& primitives, double max_growth,
                                           WorkerPool& pool);

[[nodiscard]] RelativeCost relative_cost(const Tree& tree);

}  // namespace microtrace::build
