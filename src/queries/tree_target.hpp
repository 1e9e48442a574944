#pragma once
#include "accel/build/tree.hpp"
#include "queries/kernels/kernel.hpp"

#include <microtrace/primitives.hpp>

namespace microtrace {

/// What queries search. All must outlive the searches.
struct TreeTarget {
  const Primitives& primitives;
  const Tree& tree;
  const QueryKernels& kernels;
};

}  // namespace microtrace
