#pragma once
#include "accel/build/references/references.hpp"
#include "accel/build/worker_pool.hpp"

namespace microtrace::build {

/// Sorts the items such that neighbors in space are neighbors in the array, and divides them into
/// cells, which are small parts of the scene. First, all items are sorted by their positions in the
/// scene. A range of many items with the same position, such as a detailed object in a large scene,
/// is then sorted by positions in its own box, and so on. Triangles with the same vertices have the
/// same code, and so do all items between them.
void sort(References& references, WorkerPool& pool);

}  // namespace microtrace::build
