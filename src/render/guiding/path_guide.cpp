#include "render/guiding/path_guide.hpp"

#include "base/memory_account.hpp"
#include "render/guiding/robust_mean.hpp"

#include <algorithm>
#include <numbers>
#include <span>

#include <glm/common.hpp>

namespace microtrace {
namespace {

/// A part of space with more records is divided.
constexpr std::size_t kMostRecords = 1024;
/// A part of space with fewer records, or fewer that found light, says less than those around it.
constexpr std::size_t kLeastRecords = 32, kLeastLit = 16;
constexpr int kGreatestDepth = 64;

}  // namespace

class PathGuide::Builder {
 public:
  Builder(PathGuide& guide, float brightness) : guide_(guide), brightness_(brightness) {}

  void build(std::uint32_t index, const SignedAxis& about, std::span<GuideRecord> records) {
    about_ = about;
    if (records.empty()) return;
    Box box{.low = records[0].p, .high = records[0].p};
    for (const GuideRecord& record : records) {
      box.low = glm::min(box.low, record.p);
      box.high = glm::max(box.high, record.p);
    }
    split(index, records, box, 0);
  }

 private:
  struct Box {
    Vec3 low, high;
  };

  /// Makes the tree of these records, whose root is the node `index`.
  void split(std::uint32_t index, std::span<GuideRecord> records, const Box& box, int depth) {
    const Vec3 half = 0.5F * box.high - 0.5F * box.low;
    const int axis = SignedAxis::nearest(half).axis;
    const float middle = box.low[axis] + half[axis];
    if (records.size() <= kMostRecords || depth == kGreatestDepth || !(middle > box.low[axis]) ||
        !(middle < box.high[axis]))
      return make_cell(index, records);
    const auto above = std::partition(records.begin(), records.end(),
                                      [&](const GuideRecord& r) { return r.p[axis] < middle; });
    const auto count = static_cast<std::size_t>(above - records.begin());
    const auto child = static_cast<std::uint32_t>(guide_.nodes_.size());
    guide_.nodes_[index] = {
        .split = middle, .axis = static_cast<std::uint32_t>(axis), .child = child, .cell = kNone};
    guide_.nodes_.push_back(leaf(child));
    guide_.nodes_.push_back(leaf(child + 1));
    guide_.depth_ = std::max(guide_.depth_, depth + 1);
    Box first = box, last = box;
    first.high[axis] = last.low[axis] = middle;
    // A cell that takes its records from the whole box is made before they change their order.
    if (count < kLeastRecords) make_cell(child, records);
    if (records.size() - count < kLeastRecords) make_cell(child + 1, records);
    if (count >= kLeastRecords) split(child, records.first(count), first, depth + 1);
    if (records.size() - count >= kLeastRecords)
      split(child + 1, records.subspan(count), last, depth + 1);
  }

  void make_cell(std::uint32_t index, std::span<const GuideRecord> records) {
    if (records.size() < kLeastRecords) return;
    const RobustMean mean(records, [](const GuideRecord& record) { return record.value; });
    const HemisphereBins bins(about_);
    light_.clear();
    for (const GuideRecord& record : records) {
      const std::uint64_t amount = mean.limited(record.value);
      if (amount != 0 && bins.bin(record.d) >= 0)
        light_.push_back({.d = record.d, .amount = amount});
    }
    if (light_.size() < kLeastLit) return;
    guide_.nodes_[index].cell = static_cast<std::uint32_t>(guide_.cells_.size());
    guide_.cells_.push_back(
        {.directions = distribution_of(about_, light_),
         .brightness = static_cast<float>(mean.mean() / std::numbers::pi / double{brightness_})});
    take_memory(sizeof(Cell) + guide_.cells_.back().directions.memory(), "the guide of paths");
  }

  PathGuide& guide_;
  float brightness_;
  SignedAxis about_{};
  std::vector<ArrivingLight> light_;  // working memory of make_cell()
};

PathGuide::PathGuide(GuideRecords records, float brightness) {
  for (std::uint32_t face = 0; face < 6; ++face) nodes_.push_back(leaf(face));
  for (std::uint32_t face = 0; face < 6 && brightness > 0; ++face) {
    Builder(*this, brightness)
        .build(face, {.axis = static_cast<int>(face / 2), .is_down = face % 2 != 0}, records[face]);
  }
}

void PathGuide::find(const Columns& p, const Columns& n, std::span<const Cell*> cells) const {
  std::array<std::uint32_t, kMostPoints> indices{};
  for (std::size_t i = 0; i < cells.size(); ++i) {
    indices[i] =
        static_cast<std::uint32_t>(face_index(SignedAxis::nearest({n[0][i], n[1][i], n[2][i]})));
  }
  // All points descend together, because one alone would wait for memory at every level.
  for (int level = 0; level < depth_; ++level) {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const Node& node = nodes_[indices[i]];
      indices[i] = node.child + (p[node.axis][i] < node.split ? 0 : 1);
    }
  }
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::uint32_t cell = nodes_[indices[i]].cell;
    cells[i] = cell == kNone ? nullptr : &cells_[cell];
  }
}

}  // namespace microtrace
