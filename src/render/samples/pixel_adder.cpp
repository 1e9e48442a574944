#include "render/samples/pixel_adder.hpp"

#include "float_environment.hpp"
#include "render/samples/add_sample.hpp"

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
                       std::span<PixelSum> sums)
    : kernels_(kernels), background_(background), sums_(sums) {
  const PixelSum sum;
  const double color = part_scale(sum.color[0]);
  setup_ = {.background = {background.x, background.y, background.z},
            .most = kMaxSampleLight,
            .part_scale = {color, color, color, part_scale(sum.alpha), part_scale(sum.square)}};
}

void PixelAdder::add(const RayBatch<kRandomBatch>::Results& batch) {
  const FloatEnvironment environment;
  const auto& [pixels, samples] = batch;
  constexpr std::size_t kLanes = kShadingLanes;
  for (std::size_t i = 0; i < samples.size();) {
    // The pixels of each round of samples are in ascending order.
    if (i + kLanes > samples.size() || pixels[i + kLanes - 1] - pixels[i] != kLanes - 1) {
      add_one(pixels[i], samples[i]);
      ++i;
      continue;
    }
    Lanes left =
        kernels_.sum_samples(setup_, &samples[i].color.x, terms_, static_cast<int>(pixels[i]));
    for (; left != 0; left &= left - 1) {
      const std::size_t k = i + static_cast<std::size_t>(std::countr_zero(left));
      add_one(pixels[k], samples[k]);
    }
    i += kLanes;
  }
  samples_ += samples.size();
  move_terms();
}

void PixelAdder::add_one(std::size_t pixel, const Sample& sample) {
  if (!add_sample(sums_[pixel], sample.color, sample.alpha, background_)) ++invalid_;
}

void PixelAdder::move_terms() {
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    if (terms_.count[i] == 0) continue;
    PixelSum& sum = sums_[i];
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
