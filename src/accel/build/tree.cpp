#include "accel/build/tree.hpp"

#include "accel/build/binary/binning.hpp"
#include "accel/build/instances/instances.hpp"
#include "accel/build/references/presplit.hpp"
#include "accel/build/references/references.hpp"
#include "accel/build/references/sort.hpp"
#include "accel/build/refit.hpp"
#include "accel/build/wide/tree_writer.hpp"
#include "accel/build/wide/wide_tree.hpp"
#include "base/memory_account.hpp"

#include <algorithm>
#include <cstddef>

namespace microtrace {
namespace {

constexpr int kBinsForPreview = 8;

// Minimum number of references for which starting threads pays off.
constexpr std::size_t kWorthThreads = 20000;

/// Takes primitives that are tested faster one by one out of a scene with few primitives.
void take_out_few(build::References& references) {
  build::ReferenceReader reader(references);
  references.remove_if([&](const build::CodedItem& item) {
    const PrimitiveId id = item.number();
    const bool is_other =
        !references.primitives->triangle(id) || !build::fits_blocks(reader(item).box);
    if (is_other) references.unbounded.push_back(id);
    return is_other;
  });
  std::ranges::sort(references.unbounded);
}

/// Reserves memory for the triangles of placed meshes that are not instances.
MemoryAccount room_for_copies(const Primitives& primitives, const std::vector<bool>& is_instance) {
  std::uint64_t count = 0;
  for (const ObjectRun& run : primitives.scene().objects.runs()) {
    for (std::size_t i = 0; i < run.count; ++i) {
      const PlacedMesh mesh = run.mesh(i);
      if (mesh.placement != nullptr && !is_instance[run.begin + i])
        count += mesh.arrays->triangles.size();
    }
  }
  return temporary_memory(count * kBytesOfPrimitive, kTreeMemory);
}

}  // namespace

Tree build_tree(const Primitives& primitives, BuildOptions options) {
  using namespace build;
  Tree tree;
  Instances instances(primitives, options, tree);
  PageVector<Reference> placed = instances.take_references();
  const MemoryAccount room = room_for_copies(primitives, instances.is_instance());
  References references = gather(primitives, instances.is_instance());
  WorkerPool pool(references.items.size() + placed.size() < kWorthThreads ? 1 : options.threads);
  Duplicates duplicates;
  if (!options.keeps_duplicates) {
    sort(references, pool);
    duplicates = Duplicates(references);
  }
  if (primitives.count() <= options.few) take_out_few(references);
  if (const Tree* const previous = options.previous.get();
      previous != nullptr && placed.empty() && previous->instances.empty() &&
      previous->duplicates == duplicates && previous->unbounded == references.unbounded) {
    if (std::optional<Tree> fitted =
            refitted(*previous, references, primitives, options.max_cost_growth, pool)) {
      fitted->duplicates = std::move(duplicates);
      fitted->unbounded = std::move(references.unbounded);
      return *std::move(fitted);
    }
  }
  options.previous.reset();
  tree.duplicates = std::move(duplicates);
  tree.unbounded = std::move(references.unbounded);
  tree.primitives = references.items.size();
  tree.area = references.area;
  if (!options.fast) presplit(references);
  references.store(std::move(placed));
  if (references.cells.empty()) sort(references, pool);
  references.order_stored();
  BinaryTree binary =
      build_binary_tree(std::move(references), options.fast ? kBinsForPreview : kMaxBins, pool);
  if (binary.ids.empty()) {
    tree.nodes.push_back(empty_node());
    return tree;
  }
  write_tree(binary, primitives, instances, pool, tree);
  tree.bounds = bounds_of(binary.root.box());
  return tree;
}

}  // namespace microtrace
