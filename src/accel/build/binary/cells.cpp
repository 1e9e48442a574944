#include "accel/build/binary/cells.hpp"

#include "accel/build/area.hpp"
#include "accel/build/chunks.hpp"

namespace microtrace::build {
namespace {

// A cell is dissolved if its area is larger than this multiple of the mean of all cells. Found by
// experiment: larger multiples make rays in rooms slower.
constexpr double kMostArea = 2.5;

}  // namespace

Cells::Cells(References references, WorkerPool& pool) : references_(std::move(references)) {
  const auto& begins = references_.cells;
  cells_.resize(begins.size() - 1);
  for_each_chunk(all(), pool, [&](std::span<Reference> chunk) {
    ReferenceReader reader(references_);
    for (Reference& cell : chunk) {
      const auto index = static_cast<std::uint32_t>(&cell - cells_.data());
      Box box;
      std::uint32_t weight = 0;
      for (std::uint32_t i = begins[index]; i < begins[index + 1]; ++i) {
        const Reference r = reader(references_.items, i);
        box.include(r.box);
        weight += r.weight();
      }
      cell = Reference(box, index, weight);
    }
  });
  dissolve_large();
}

void Cells::dissolve_large() {
  const AreaMeasure area(references_.box);
  double sum = 0;
  for (const Reference& cell : cells_) sum += area(cell.box);
  const double most = kMostArea * sum / static_cast<double>(cells_.size());
  PageVector<std::uint32_t> begins;
  PageVector<Reference> cells;
  begins.reserve(references_.cells.size());
  cells.reserve(cells_.size());
  const auto add = [&](std::uint32_t begin, const Reference& r) {
    cells.emplace_back(r.box, static_cast<std::uint32_t>(begins.size()), r.weight());
    begins.push_back(begin);
  };
  ReferenceReader reader(references_);
  for (const Reference& cell : cells_) {
    if (area(cell.box) > most) {
      for (std::uint32_t i = begin(cell); i < end(cell); ++i) add(i, reader(references_.items, i));
    } else {
      add(begin(cell), cell);
    }
  }
  begins.push_back(references_.cells.back());
  references_.cells = std::move(begins);
  cells_ = std::move(cells);
}

std::uint32_t Cells::size(std::span<const Reference> cells) const {
  std::uint32_t sum = 0;
  for (const Reference& cell : cells) sum += end(cell) - begin(cell);
  return sum;
}

void Cells::take(std::span<const Reference> cells, Reference* to) {
  ReferenceReader reader(references_);
  for (const Reference& cell : cells) {
    for (std::size_t i = begin(cell); i < end(cell); ++i) {
      *to++ = reader(references_.items, i);
      const CodedItem& item = references_.items[i];
      if (item.is_stored()) used_stored_(item.number(), 1);
    }
    used_items_(begin(cell), end(cell) - begin(cell));
  }
}

}  // namespace microtrace::build
