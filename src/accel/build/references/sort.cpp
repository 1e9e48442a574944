#include "accel/build/references/sort.hpp"

#include "accel/build/chunks.hpp"
#include "accel/build/references/morton.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <span>
#include <utility>
#include <vector>

namespace microtrace::build {
namespace {

constexpr unsigned kDigitBits = 11, kDigits = 1U << kDigitBits;
constexpr std::size_t kChunk = std::size_t{1} << 17U;

// Ranges of at most this number of items are sorted by one thread each.
constexpr std::size_t kSortedAlone = 4096;
// Number of such ranges that a thread sorts at a time.
constexpr std::size_t kRangesPerJob = 64;

// Sorts items by ascending codes of this number of bits, one digit after the other, from the
// lowest. Keeps the order of items with the same code.
void radix_sort(std::span<CodedItem> items, unsigned bits, WorkerPool& pool) {
  PageVector<CodedItem> other(items.size());
  std::span<CodedItem> from = items, to = other;
  for (unsigned shift = 0; shift < bits; shift += kDigitBits) {
    const auto digit = [&](const CodedItem& item) { return item.code() >> shift & (kDigits - 1); };
    const Chunks<CodedItem, kChunk> chunks(from);
    // The number of items with each digit, then the place of the next of them
    std::vector<std::array<std::uint32_t, kDigits>> places(chunks.size());
    pool.run(chunks.size(), [&](std::size_t i) {
      for (const CodedItem& item : chunks[i]) ++places[i][digit(item)];
    });
    std::uint32_t next = 0;
    for (unsigned d = 0; d < kDigits; ++d)
      for (auto& chunk : places) next += std::exchange(chunk[d], next);
    pool.run(chunks.size(), [&](std::size_t i) {
      for (const CodedItem& item : chunks[i]) to[places[i][digit(item)]++] = item;
    });
    std::swap(from, to);
  }
  if (from.data() != items.data()) std::ranges::copy(from, items.begin());
}

struct Range {
  std::size_t begin, end;
  [[nodiscard]] std::size_t size() const { return end - begin; }
};

/// Sorts ranges of items and divides them into cells.
class CellSorter {
 public:
  CellSorter(References& references, WorkerPool& pool, std::span<const Range> remaining = {})
      : references_(references), pool_(pool), remaining_(remaining.begin(), remaining.end()) {}

  /// Sorts a range of items with centroids in a box. Parts of more than kCellSize items with the
  /// same position remain to be sorted.
  void sort(Range range, const Box& centroids) {
    const std::span<CodedItem> items = in(range);
    const unsigned bits =
        std::min(2 * static_cast<unsigned>(std::bit_width(items.size())), CodedItem::kPositionBits);
    const MortonCode code(centroids, bits);
    for_each_chunk(items, pool_, [&](std::span<CodedItem> chunk) {
      ReferenceReader reader(references_);
      for (std::size_t i = 0; i < chunk.size(); ++i)
        chunk[i].set_code(code(centroid(reader(chunk, i).box)), reader.mark(chunk[i]));
    });
    if (items.size() > kSortedAlone)
      radix_sort(items, bits + CodedItem::kMarkBits, pool_);
    else
      std::ranges::sort(items, {}, [](const CodedItem& item) { return item.key(); });
    if (code.is_degenerate())
      cut(range);
    else
      divide(range);
  }

  /// Sorts remaining parts until they have at most this number of items.
  void sort_remaining(std::size_t most) {
    std::vector<Range> small;
    while (!remaining_.empty()) {
      const Range range = remaining_.back();
      remaining_.pop_back();
      if (range.size() > most)
        sort(range, centroids_of(range));
      else
        small.push_back(range);
    }
    remaining_ = std::move(small);
  }

  [[nodiscard]] const std::vector<Range>& remaining() const { return remaining_; }
  /// The begins of all cells so far
  [[nodiscard]] PageVector<std::uint32_t>& begins() { return begins_; }

 private:
  [[nodiscard]] std::span<CodedItem> in(Range range) {
    return std::span(references_.items).subspan(range.begin, range.size());
  }

  [[nodiscard]] Box centroids_of(Range range) {
    const Chunks<CodedItem> chunks(in(range));
    std::vector<Box> boxes(chunks.size());
    pool_.run(chunks.size(), [&](std::size_t chunk) {
      ReferenceReader reader(references_);
      for (std::size_t i = 0; i < chunks[chunk].size(); ++i)
        boxes[chunk].include(centroid(reader(chunks[chunk], i).box));
    });
    Box all;
    for (const Box& box : boxes) all.include(box);
    return all;
  }

  // Divides a sorted range by the highest bit in which its positions differ, until the parts are
  // cells.
  void divide(Range range) {
    const auto items = references_.items.begin();
    const auto first = items + static_cast<std::ptrdiff_t>(range.begin),
               last = items + static_cast<std::ptrdiff_t>(range.end);
    if (range.size() <= kCellSize) {
      begins_.push_back(static_cast<std::uint32_t>(range.begin));
      return;
    }
    const std::uint32_t differing = first->position() ^ (last - 1)->position();
    if (differing == 0) {
      remaining_.push_back(range);
      return;
    }
    const std::uint32_t bit = std::bit_floor(differing);
    const auto is_left = [&](const CodedItem& item) { return (item.position() & bit) == 0; };
    const auto middle =
        static_cast<std::size_t>(std::partition_point(first, last, is_left) - items);
    divide({range.begin, middle});
    divide({middle, range.end});
  }

  // Cuts a range of equal centroids into cells.
  void cut(Range range) {
    for (std::size_t i = range.begin; i < range.end; i += kCellSize)
      begins_.push_back(static_cast<std::uint32_t>(i));
  }

  References& references_;
  WorkerPool& pool_;
  std::vector<Range> remaining_;
  PageVector<std::uint32_t> begins_;
};

}  // namespace

void sort(References& references, WorkerPool& pool) {
  const std::size_t count = references.items.size();
  CellSorter sorter(references, pool);
  const Box& box = references.box;
  if (count > 0) sorter.sort({0, count}, {.lo = box.lo * splat(0.5F), .hi = box.hi * splat(0.5F)});
  sorter.sort_remaining(kSortedAlone);
  PageVector<std::uint32_t>& cells = references.cells = std::move(sorter.begins());
  const std::span<const Range> ranges = sorter.remaining();
  std::vector<PageVector<std::uint32_t>> begins((ranges.size() + kRangesPerJob - 1) /
                                                kRangesPerJob);
  pool.run(begins.size(), [&](std::size_t job) {
    WorkerPool alone(1);
    const std::size_t first = job * kRangesPerJob;
    CellSorter own(references, alone,
                   ranges.subspan(first, std::min(kRangesPerJob, ranges.size() - first)));
    own.sort_remaining(0);
    begins[job] = std::move(own.begins());
  });
  for (const auto& own : begins) cells.insert(cells.end(), own.begin(), own.end());
  if (!std::ranges::is_sorted(cells)) std::ranges::sort(cells);
  cells.push_back(static_cast<std::uint32_t>(count));
}

}  // namespace microtrace::build
