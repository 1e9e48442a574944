#include "render/samples/pixel_adder.hpp"

#include "base/system/float_environment.hpp"
#include "render/film/add_sample.hpp"
#include "simd/vector_types.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>

namespace microtrace {
namespace {

template <std::size_t Words, int FractionBits>
constexpr double part_scale(const FixedSum<Words, FractionBits>& /*sum*/) {
  return static_cast<double>(std::uint64_t{1} << (FractionBits - 32U));
}

/// A sample is loaded as four floats.
static_assert(sizeof(Sample) == 4 * sizeof(float) && offsetof(Sample, color) == 0);
static_assert(kRandomBatch <= 1024, "see TermSums");

}  // namespace

PixelAdder::PixelAdder(const ShadingKernels& kernels, const Vec3& background,
                       std::span<PixelSum> sums, std::span<const std::size_t> places)
    : kernels_(kernels), background_(background), sums_(sums), places_(places) {
  const PixelSum sum;
  const double color = part_scale(sum.color[0]);
  setup_ = {.background = {background.x, background.y, background.z},
            .most = kMaxSampleLight,
            .part_scale = {color, color, color, part_scale(sum.alpha), part_scale(sum.square)}};
}

std::size_t PixelAdder::samples_per_pixel(const Results& batch, std::size_t first) {
  const auto pixels = batch.pixels.subspan(first);
  const std::size_t count = static_cast<std::size_t>(
      std::ranges::find_if(pixels, [&](std::size_t pixel) { return pixel != pixels[0]; }) -
      pixels.begin());
  if (count * kShadingLanes > pixels.size()) return 0;
  // The pixels of each round of samples are in ascending order.
  for (std::size_t lane = 0; lane < kShadingLanes; ++lane) {
    const std::size_t pixel = pixels[0] + lane;
    if (pixels[lane * count] != pixel || pixels[(lane + 1) * count - 1] != pixel) return 0;
  }
  return count;
}

void PixelAdder::add(const Results& batch) {
  const FloatEnvironment environment;
  const auto& [pixels, samples] = batch;
  for (std::size_t first = 0; first < samples.size();) {
    const std::size_t count = samples_per_pixel(batch, first);
    if (count == 0) {
      add_one(pixels[first], samples[first]);
      ++first;
      continue;
    }
    for (std::size_t i = first; i < first + count; ++i) {
      Lanes left = kernels_.sum_samples(setup_, &samples[i].color.x, count, terms_, pixels[first]);
      for (; left != 0; left &= left - 1) {
        const std::size_t k = i + count * static_cast<std::size_t>(std::countr_zero(left));
        add_one(pixels[k], samples[k]);
      }
    }
    first += count * kShadingLanes;
  }
  samples_ += samples.size();
  move_terms();
}

void PixelAdder::add_one(std::size_t pixel, const Sample& sample) {
  if (!add_sample(sums_[places_[pixel]], sample.color, sample.alpha, background_)) ++invalid_;
}

void PixelAdder::move_terms() {
  for (std::size_t i = 0; i < places_.size(); ++i) {
    if (terms_.count[i] == 0) continue;
    PixelSum& sum = sums_[places_[i]];
    const auto move = [&](TermSums::Term term, auto& to) {
      to.add(terms_.whole[term][i], terms_.part[term][i]);
    };
    move(TermSums::red, sum.color[0]);
    move(TermSums::green, sum.color[1]);
    move(TermSums::blue, sum.color[2]);
    move(TermSums::alpha, sum.alpha);
    move(TermSums::square, sum.square);
    sum.count += terms_.count[i];
  }
  terms_ = {};
}

}  // namespace microtrace
