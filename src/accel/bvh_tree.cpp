#include "accel/bvh_tree.hpp"

#include "accel/build/references/reference.hpp"
#include "float_environment.hpp"

#include <microtrace/error.hpp>

#include <cstdint>
#include <utility>

namespace microtrace {
namespace {

// Maximum number of primitives for which testing all of them is faster than traversing a tree.
constexpr PrimitiveId kFew = 16;

// Upper bound of the memory per primitive during the build, including pieces of split triangles.
constexpr std::uint64_t kBytesOfPrimitive = 120;

constexpr const char* kMemoryUse = "the tree of primitives";

Tree tree_of_few(const Primitives& primitives) {
  build::References references = build::gather(primitives);
  Tree tree;
  tree.duplicates = Duplicates(references, primitives);
  tree.unbounded = std::move(references.unbounded);
  for (const build::Reference& reference : references.bounded)
    tree.unbounded.push_back(reference.id());
  return tree;
}

/// Reserves memory for a build. Releases the previous tree if the budget has no room for both
/// trees.
MemoryAccount room_for_build(PrimitiveId count, BvhOptions& options) {
  if (options.previous) {
    try {
      return temporary_memory(count * kBytesOfPrimitive, kMemoryUse);
    } catch (const Error&) {
      options.previous.reset();
    }
  }
  return temporary_memory(count * kBytesOfPrimitive, kMemoryUse);
}

Tree tree_of_many(const Primitives& primitives, BvhOptions& options) {
  const MemoryAccount room = room_for_build(primitives.count(), options);
  BuildOptions build{.fast = options.fast_build,
                     .threads = options.threads,
                     .max_cost_growth = options.max_cost_growth};
  if (const BvhTree* const previous = options.previous.get())
    build.previous = {std::move(options.previous), &previous->tree};
  return build_tree(primitives, std::move(build));
}

}  // namespace

std::shared_ptr<const BvhTree> make_bvh_tree(const Primitives& primitives, BvhOptions options) {
  const FloatEnvironment environment;
  MemoryAccount memory(memory_account().budget());
  if (primitives.count() <= kFew)
    return std::make_shared<BvhTree>(
        BvhTree{.tree = tree_of_few(primitives), .memory = std::move(memory)});
  Tree tree = tree_of_many(primitives, options);
  memory.take(memory_of(tree), kMemoryUse);
  return std::make_shared<BvhTree>(BvhTree{.tree = std::move(tree), .memory = std::move(memory)});
}

std::size_t memory_of(const Tree& tree) {
  const auto bytes = [](const auto& list) { return list.size() * sizeof list[0]; };
  return bytes(tree.nodes) + bytes(tree.blocks) + bytes(tree.others) + bytes(tree.unbounded) +
         tree.duplicates.memory();
}

}  // namespace microtrace
