#include "accel/build/binary/partition.hpp"

#include <array>
#include <limits>
#include <utility>
#include <vector>

namespace microtrace::build {
namespace {

void include(CentroidBoxes& boxes, const Reference& r, bool goes_right) {
  const float infinity = std::numeric_limits<float>::infinity();
  const Float4 c = centroid(r.box);
  const Int4 is_right = splat(static_cast<float>(goes_right)) > splat(0.5F);
  boxes.left.lo = min(boxes.left.lo, is_right ? splat(infinity) : c);
  boxes.left.hi = max(boxes.left.hi, is_right ? splat(-infinity) : c);
  boxes.right.lo = min(boxes.right.lo, is_right ? c : splat(infinity));
  boxes.right.hi = max(boxes.right.hi, is_right ? c : splat(-infinity));
}

bool goes_right(const Reference& r, const BinMapping& mapping, const Split& split) {
  return mapping(r)[split.axis] > split.last_bin;
}

/// The references of a chunk that belong to the other part of the set.
struct Misplaced {
  std::span<const std::uint16_t> positions;  ///< in the chunk
  std::size_t before = 0;                    ///< number of those in the chunks before
  CentroidBoxes centroids;                   ///< of all references of the chunk
};

/// The range of one part of a set, in which the references of both parts are still mixed.
struct Part {
  Chunks<Reference> chunks;
  Chunks<std::uint16_t> positions;
  std::vector<Misplaced> misplaced;

  Part(std::span<Reference> references, std::span<std::uint16_t> room)
      : chunks(references), positions(room), misplaced(chunks.size()) {}

  /// Finds the misplaced references of a chunk without a branch, which would be unpredictable.
  void find(std::size_t i, const BinMapping& mapping, const Split& split, bool is_right) {
    const std::span<const Reference> chunk = chunks[i];
    std::array<std::uint16_t, Chunks<Reference>::kSize> found;
    std::size_t count = 0;
    CentroidBoxes centroids;
    for (std::size_t k = 0; k < chunk.size(); ++k) {
      prefetch_after(chunk[k]);
      const bool to_right = goes_right(chunk[k], mapping, split);
      found[count] = static_cast<std::uint16_t>(k);
      count += static_cast<std::size_t>(to_right != is_right);
      include(centroids, chunk[k], to_right);
    }
    std::copy_n(found.begin(), count, positions[i].begin());
    misplaced[i] = {.positions = positions[i].first(count), .centroids = centroids};
  }

  void number() {
    for (std::size_t i = 1; i < misplaced.size(); ++i)
      misplaced[i].before = misplaced[i - 1].before + misplaced[i - 1].positions.size();
  }
};

/// Exchanges the misplaced references of a chunk of the left part with as many of the right part.
void exchange(const Part& left, std::size_t chunk, const Part& right) {
  const Misplaced& from = left.misplaced[chunk];
  if (from.positions.empty()) return;
  auto to = std::ranges::upper_bound(right.misplaced, from.before, {}, &Misplaced::before) - 1;
  std::size_t next = from.before - to->before;
  for (const std::uint16_t position : from.positions) {
    while (next == to->positions.size()) {
      ++to;
      next = 0;
    }
    const auto other = static_cast<std::size_t>(to - right.misplaced.begin());
    std::swap(left.chunks[chunk][position], right.chunks[other][to->positions[next++]]);
  }
}

}  // namespace

CentroidBoxes partition(std::span<Reference> set, const BinMapping& mapping, const Split& split,
                        Reference* scratch) {
  CentroidBoxes centroids;
  std::array<Reference*, 2> to{set.data(), scratch};
  for (const Reference& from : set) {
    prefetch_after(from);
    const Reference r = from;
    const bool to_right = goes_right(r, mapping, split);
    *to[to_right]++ = r;  // without a branch, which would be unpredictable
    include(centroids, r, to_right);
  }
  std::copy(scratch, to[1], to[0]);
  return centroids;
}

CentroidBoxes partition_together(std::span<Reference> set, const BinMapping& mapping,
                                 const Split& split, std::span<std::uint16_t> scratch,
                                 WorkerPool& pool) {
  const std::size_t left = split.left_load.count;
  std::array parts{Part(set.first(left), scratch.first(left)),
                   Part(set.subspan(left), scratch.subspan(left))};
  const std::size_t left_chunks = parts[0].chunks.size();
  pool.run(left_chunks + parts[1].chunks.size(), [&](std::size_t i) {
    const bool is_right = i >= left_chunks;
    parts[is_right].find(is_right ? i - left_chunks : i, mapping, split, is_right);
  });
  for (Part& part : parts) part.number();
  pool.run(left_chunks, [&](std::size_t i) { exchange(parts[0], i, parts[1]); });
  CentroidBoxes centroids;
  for (const Part& part : parts)
    for (const Misplaced& chunk : part.misplaced) centroids.include(chunk.centroids);
  return centroids;
}

}  // namespace microtrace::build
