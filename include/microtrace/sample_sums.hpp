#pragma once
/// Sums of samples, for pictures that are rendered in several passes, in several runs of the
/// program, or on several machines.

#include <microtrace/export.hpp>
#include <microtrace/film.hpp>
#include <microtrace/fixed_sum.hpp>
#include <microtrace/math.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace microtrace {

/// Maximum value of a sample's color components. A pixel has at most 2^16 samples, so their sum is
/// at most 2^62.
inline constexpr double kMaxSampleLight = 0x1p46;

/// The sums of one pixel's samples. Samples are truncated to multiples of 2^-64 (alpha: 2^-46,
/// squares: 2^-80), whose sums are exact. The same samples therefore give the same bits in any
/// order and grouping.
struct MICROTRACE_EXPORT PixelSum {
  std::array<FixedSum<2, 64>, 3> color{};
  FixedSum<1, 46> alpha{};
  FixedSum<3, 80> square{};  ///< sum of the squares of the displayed luminance
  std::uint32_t count = 0;   ///< number of samples

  /// Adds an integrator's sample composited over this background. If the sample is NaN, counts it
  /// as black and returns false.
  bool add(const Vec3& sample, float sample_alpha, const Vec3& background);

  PixelSum& operator+=(const PixelSum& other);

  [[nodiscard]] Vec3 mean_color() const;   ///< black if there are no samples
  [[nodiscard]] float mean_alpha() const;  ///< 0 if there are no samples
  /// Returns the estimated variance of the mean displayed luminance; 0 for fewer than two samples.
  /// The estimate assumes independent samples; low-discrepancy samples have a smaller variance.
  [[nodiscard]] double variance(const Vec3& background) const;
  [[nodiscard]] double mean_luminance(const Vec3& background) const;  ///< mean displayed luminance

  [[nodiscard]] bool operator==(const PixelSum&) const = default;
};

/// Samples [first, last) of each pixel.
struct SampleRange {
  std::uint32_t first = 0, last = 0;

  [[nodiscard]] std::uint32_t size() const { return last - first; }
  [[nodiscard]] bool operator==(const SampleRange&) const = default;
};

/// The sums of all pixels in a part of a picture.
class MICROTRACE_EXPORT SampleSums {
 public:
  SampleSums() = default;
  /// Creates sums without samples for the pixels of `window`. Throws std::bad_alloc.
  SampleSums(ImageSize whole, const PixelRect& window, const Vec3& background);

  ImageSize whole;                 ///< size of the whole picture
  PixelRect window;                ///< the part of the picture that these sums cover
  Vec3 background{0};              ///< background under the samples, for luminance; black if the
                                   ///< picture has alpha
  std::vector<PixelSum> pixels{};  ///< by pixel of the window, row by row from the upper left

  [[nodiscard]] PixelSum& at(std::uint32_t x, std::uint32_t y) { return pixels[index(x, y)]; }
  [[nodiscard]] const PixelSum& at(std::uint32_t x, std::uint32_t y) const {
    return pixels[index(x, y)];
  }

  /// Returns the ranges of samples that were added, in ascending order, possibly with gaps.
  /// Converged pixels hold only the first of these samples.
  [[nodiscard]] const std::vector<SampleRange>& ranges() const { return ranges_; }
  /// Returns the number of samples per pixel in ranges().
  [[nodiscard]] std::uint32_t count() const;
  /// Returns the parts of `wanted` that were not added yet, in ascending order.
  [[nodiscard]] std::vector<SampleRange> missing(const SampleRange& wanted) const;
  [[nodiscard]] bool overlaps(const SampleRange& range) const;
  /// Records that these samples were added. The range must not overlap ranges recorded before.
  void note(const SampleRange& range);

  /// Adds other samples of the same window of the same picture. None of them may be present
  /// already.
  SampleSums& operator+=(const SampleSums& other);

 private:
  /// x and y are coordinates in the whole picture.
  [[nodiscard]] std::size_t index(std::uint32_t x, std::uint32_t y) const {
    return std::size_t{y - window.y0} * window.size().width + (x - window.x0);
  }

  std::vector<SampleRange> ranges_;
};

/// Computes the channels that depend only on the sums: those of SampledAov::variance and
/// SampledAov::samples. Leaves other channels as they are.
MICROTRACE_EXPORT void compute_channels(const SampleSums& sums, std::span<Channel> channels);

/// Returns true if compute_channels() computes the channel with this name.
[[nodiscard]] MICROTRACE_EXPORT bool is_computed_channel(std::string_view name);

/// Returns the picture of the samples so far, either with alpha or over the background.
[[nodiscard]] MICROTRACE_EXPORT Film develop(const SampleSums& sums, Film::Alpha alpha);

}  // namespace microtrace
