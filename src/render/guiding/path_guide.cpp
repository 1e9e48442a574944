#include "render/guiding/path_guide.hpp"

#include "base/memory_account.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <span>

#include <glm/common.hpp>

namespace microtrace {
namespace {

long env(const char* name, long value) {
  const char* text = std::getenv(name);
  return text ? std::atol(text) : value;
}
const std::size_t kMostRecords = static_cast<std::size_t>(env("G_MOST", 2048));
constexpr std::size_t kLeastRecords = 32;
constexpr std::size_t kLeastLit = 16;
constexpr int kGreatestDepth = 24;
/// A record counts at most this many times the mean of its cell, so that a bright exception does
/// not attract most samples.
const double kMostOfMean = static_cast<double>(env("G_CLAMP", 32));

}  // namespace

class PathGuide::Builder {
 public:
  explicit Builder(PathGuide& guide) : guide_(guide) {}

  void build(std::uint32_t index, const SignedAxis& about, std::span<GuideRecord> records) {
    about_ = about;
    if (records.empty()) return;
    Vec3 low = records[0].p, high = low;
    for (const GuideRecord& record : records) {
      low = glm::min(low, record.p);
      high = glm::max(high, record.p);
    }
    split(index, records, low, high, 0);
  }

 private:
  void split(std::uint32_t index, std::span<GuideRecord> records, const Vec3& low,
             const Vec3& high, int depth) {
    const Vec3 extent = high - low;
    const int axis = extent.x >= extent.y ? (extent.x >= extent.z ? 0 : 2)
                                          : (extent.y >= extent.z ? 1 : 2);
    const float middle = low[axis] + 0.5F * extent[axis];
    const bool is_leaf = records.size() <= kMostRecords || depth == kGreatestDepth ||
                         !(middle > low[axis]) || !(middle < high[axis]);
    if (is_leaf) return make_cell(index, records);
    const auto second = std::partition(records.begin(), records.end(), [&](const GuideRecord& r) {
      return r.p[axis] < middle;
    });
    const auto count = static_cast<std::size_t>(second - records.begin());
    const auto child = static_cast<std::uint32_t>(guide_.nodes_.size());
    guide_.nodes_[index] = {.split = middle, .child = child, .axis = axis};
    guide_.nodes_.resize(guide_.nodes_.size() + 2);
    Vec3 below = high, above = low;
    below[axis] = above[axis] = middle;
    const std::span<GuideRecord> first = records.first(count), last = records.subspan(count);
    // Too few records say less about a part of space than those around it.
    const auto build_half = [&](std::uint32_t half, std::span<GuideRecord> own, const Vec3& from,
                                const Vec3& to) {
      if (own.size() < kLeastRecords)
        make_cell(half, records);
      else
        split(half, own, from, to, depth + 1);
    };
    if (first.size() < kLeastRecords) {
      // makes this cell before the records change their order
      build_half(child, first, low, below);
      build_half(child + 1, last, above, high);
    } else {
      build_half(child + 1, last, above, high);
      build_half(child, first, low, below);
    }
  }

  void make_cell(std::uint32_t index, std::span<const GuideRecord> records) {
    if (records.size() < kLeastRecords) return;
    float greatest = 0;
    for (const GuideRecord& record : records) greatest = std::max(greatest, record.value);
    if (!(greatest > 0) || !std::isfinite(greatest)) return;
    // Sums of integers don't depend on the order.
    const double unit = std::ldexp(1.0, 40 - std::ilogb(greatest));
    std::uint64_t sum = 0;
    for (const GuideRecord& record : records)
      sum += static_cast<std::uint64_t>(double{record.value} * unit);
    const double most = kMostOfMean * static_cast<double>(sum) / static_cast<double>(records.size());
    const HemisphereBins bins(about_);
    std::uint64_t clamped = 0;
    light_.clear();
    for (const GuideRecord& record : records) {
      const auto value = static_cast<std::uint64_t>(std::min(double{record.value} * unit, most));
      clamped += value;
      if (value != 0 && bins.bin(record.d) >= 0) light_.push_back({.d = record.d, .amount = value});
    }
    if (light_.size() < kLeastLit) return;
    guide_.nodes_[index].child = static_cast<std::uint32_t>(guide_.cells_.size());
    guide_.cells_.push_back(
        {.directions = GuideDistribution(about_, light_),
         .irradiance = static_cast<float>(static_cast<double>(clamped) / unit /
                                          static_cast<double>(records.size()))});
  }

  PathGuide& guide_;
  SignedAxis about_{};
  std::vector<GuideDistribution::Light> light_;
};

PathGuide::PathGuide(GuideRecords records, float brightness) : brightness_(brightness), nodes_(6) {
  Builder builder(*this);
  for (std::uint32_t face = 0; face < 6; ++face) {
    roots_[face] = face;
    builder.build(face, {.axis = static_cast<int>(face / 2), .is_down = face % 2 != 0},
                  records[face]);
  }
  take_memory(cells_.size() * sizeof(Cell), "the guide of paths");
}

}  // namespace microtrace
