#include "accel/bvh_tree.hpp"

#include "accel/build/instances/instances.hpp"
#include "accel/build/instances/mesh_tree.hpp"
#include "base/system/float_environment.hpp"

#include <microtrace/error.hpp>

#include <cstdint>
#include <utility>

namespace microtrace {
namespace {

// In scenes with at most this number of primitives, testing each primitive that is not a triangle
// is faster than traversal.
constexpr PrimitiveId kFew = 16;

/// Reserves memory for a build. Releases the previous tree if the budget has no room for both
/// trees.
MemoryAccount room_for_build(std::uint64_t bytes, BvhOptions& options) {
  if (options.previous) {
    try {
      return temporary_memory(bytes, kTreeMemory);
    } catch (const Error&) {
      options.previous.reset();
    }
  }
  return temporary_memory(bytes, kTreeMemory);
}

Tree make_tree(const Primitives& primitives, BvhOptions& options) {
  const MemoryAccount room = room_for_build(build::memory_to_build(primitives), options);
  BuildOptions build{.fast = options.fast_build,
                     .threads = options.threads,
                     .max_cost_growth = options.max_cost_growth,
                     .few = kFew};
  if (const BvhTree* const previous = options.previous.get())
    build.previous = {std::move(options.previous), &previous->tree};
  return build_tree(primitives, std::move(build));
}

}  // namespace

std::shared_ptr<const BvhTree> make_bvh_tree(const Primitives& primitives, BvhOptions options) {
  const FloatEnvironment environment;
  MemoryAccount memory(memory_account().budget());
  Tree tree = make_tree(primitives, options);
  memory.take(memory_of(tree), kTreeMemory);
  return std::make_shared<BvhTree>(BvhTree{.tree = std::move(tree), .memory = std::move(memory)});
}

std::size_t memory_of(const Tree& tree) {
  const auto bytes = [](const auto& list) { return list.size() * sizeof list[0]; };
  std::size_t result = bytes(tree.nodes) + bytes(tree.blocks) + bytes(tree.others) +
                       bytes(tree.unbounded) + bytes(tree.instances) + tree.duplicates.memory();
  for (const auto& mesh : tree.meshes) result += memory_of(mesh->tree);
  return result;
}

}  // namespace microtrace
