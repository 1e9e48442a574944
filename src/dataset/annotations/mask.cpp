#include "dataset/annotations/mask.hpp"

#include <algorithm>
#include <cstddef>

namespace microtrace::dataset {

void Mask::add(std::uint32_t x, std::uint32_t y) {
  if (area_ == 0) {
    box_ = {.x0 = x, .y0 = y, .x1 = x + 1, .y1 = y + 1};
  } else {
    box_.x0 = std::min(box_.x0, x);
    box_.x1 = std::max(box_.x1, x + 1);
    box_.y1 = y + 1;
  }
  ++area_;
  if (!runs_.empty() && runs_.back().y == y && runs_.back().x1 == x)
    ++runs_.back().x1;
  else
    runs_.push_back({.y = y, .x0 = x, .x1 = x + 1});
}

std::vector<std::uint64_t> column_counts(const Mask& mask, ImageSize size) {
  struct Interval {
    std::uint32_t y0, y1;
  };
  const PixelRect& box = mask.box();
  std::vector<std::vector<Interval>> columns(box.size().width);
  for (const PixelRun& run : mask.runs()) {
    for (std::uint32_t x = run.x0; x < run.x1; ++x) {
      std::vector<Interval>& column = columns[x - box.x0];
      if (!column.empty() && column.back().y1 == run.y)
        ++column.back().y1;
      else
        column.push_back({.y0 = run.y, .y1 = run.y + 1});
    }
  }
  // The last count is that of the pixels up to `end`; counts of odd index are inside the mask.
  std::vector<std::uint64_t> counts{0};
  std::uint64_t end = 0;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const std::uint64_t first = (box.x0 + k) * size.height;
    for (const Interval& interval : columns[k]) {
      const std::uint64_t from = first + interval.y0, length = interval.y1 - interval.y0;
      if (from == end && counts.size() % 2 == 0) {
        counts.back() += length;  // continues from the bottom of the previous column
      } else {
        if (counts.size() % 2 == 0) counts.push_back(0);
        counts.back() = from - end;
        counts.push_back(length);
      }
      end = from + length;
    }
  }
  const std::uint64_t pixels = std::uint64_t{size.width} * size.height;
  if (counts.size() == 1)
    counts[0] = pixels;
  else if (end < pixels)
    counts.push_back(pixels - end);
  return counts;
}

std::string compressed_counts(const std::vector<std::uint64_t>& counts) {
  std::string text;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    auto left = static_cast<std::int64_t>(counts[i]);
    if (i > 2) left -= static_cast<std::int64_t>(counts[i - 2]);
    bool is_more = true;
    while (is_more) {
      auto group = static_cast<unsigned>(left & 0x1F);
      left >>= 5;
      is_more = (group & 0x10U) != 0 ? left != -1 : left != 0;
      if (is_more) group |= 0x20U;
      text += static_cast<char>(group + 48);
    }
  }
  return text;
}

}  // namespace microtrace::dataset
