#pragma once
#include "accel/build/float4.hpp"
#include "accel/build/tree.hpp"

#include <microtrace/primitives.hpp>

#include <cstdint>
#include <vector>

namespace microtrace::build {

/// Adds the instances of a scene, and trees of their meshes, to `tree`, and their boxes to `boxes`.
/// Takes trees of meshes from options.previous if it has them. Returns, for each object, whether it
/// is an instance. Placed meshes that make_instance() refuses are not, so their triangles belong in
/// the tree like those of other objects.
[[nodiscard]] std::vector<bool> find_instances(const Primitives& primitives,
                                               const BuildOptions& options, Tree& tree,
                                               std::vector<Box>& boxes);

/// Returns an upper bound of the memory of a build, in which each shared mesh counts once, unless
/// make_instance() refuses placements.
[[nodiscard]] std::uint64_t memory_to_build(const Primitives& primitives);

}  // namespace microtrace::build
