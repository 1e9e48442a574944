#pragma once
/// Refits a tree to new positions of its primitives, which takes about half of the time of a build.
/// After I. Wald, S. Boulos, P. Shirley, Ray tracing deformable scenes using dynamic bounding
/// volume hierarchies, 2007, section 3.

#include "accel/build/references/references.hpp"
#include "accel/build/tree.hpp"
#include "accel/build/worker_pool.hpp"

#include <microtrace/primitives.hpp>

#include <optional>

namespace microtrace::build {

/// Returns the previous tree refitted to the primitives' new shapes; the caller sets `duplicates`
/// and `unbounded`. A triangle that moved gets a box around the whole triangle, even if the tree
/// was built with boxes of its pieces. A leaf in which nothing moved keeps its box.
///
/// `references` must refer to all primitives that belong in a tree. Returns nothing in four cases:
/// the previous tree has different primitives; a new tree would store a primitive in a different
/// kind of leaf; triangles of a block have moved apart and have too many vertices; or a relative
/// cost would exceed max_growth times its value when the tree was
/// built.
[[nodiscard]] std::optional<Tree> refitted(const Tree& previous, const References& references,
                                           const Primitives& primitives, double max_growth,
                                           WorkerPool& pool);

[[nodiscard]] RelativeCost relative_cost(const Tree& tree);

}  // namespace microtrace::build
