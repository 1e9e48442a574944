#pragma once
#include "accel/build/tree.hpp"
#include "queries/kernels/kernel.hpp"

#include <microtrace/primitives.hpp>

namespace microtrace {

/// The tree that a query searches, with its primitives and kernels. All members must outlive the
/// query.
struct TreeTarget {
  const Primitives& primitives;
  const Tree& tree;
  const QueryKernels& kernels;
};

}  // namespace microtrace
