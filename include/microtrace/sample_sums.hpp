#pragma once
/// Sample sums of a picture that is rendered in parts: in several passes, several runs of the
/// program, or on several machines.

#include <microtrace/export.hpp>
#include <microtrace/film.hpp>
#include <microtrace/fixed_sum.hpp>
#include <microtrace/math.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace microtrace {

/// Maximum value of a sample. A pixel has at most 2^16 samples, so their sum stays below 2^62.
inline constexpr double kMaxSampleLight = 0x1p46;

/// The sums of one pixel's samples. Sums of multiples of 2^-64 (alpha 2^-46, squares 2^-80) are
/// exact, so the same samples give the same bits in any order and grouping.
struct MICROTRACE_EXPORT PixelSum {
  std::array<FixedSum<2, 64>, 3> color{};
  FixedSum<1, 46> alpha{};
  FixedSum<3, 80> square{};  ///< of the displayed luminance
  std::uint32_t count = 0;   ///< number of samples

  /// Adds an integrator's sample over this background. Returns false, and counts it as black, if it
  /// is NaN.
  bool add(const Vec3& sample, float sample_alpha, const Vec3& background);

  PixelSum& operator+=(const PixelSum& other);

  [[nodiscard]] Vec3 mean_color() const;   ///< black without samples
  [[nodiscard]] float mean_alpha() const;  ///< 0 without samples
  /// The estimated variance of the mean displayed luminance. The estimate is for independent
  /// samples; low-discrepancy samples have a smaller variance. 0 for less than two samples.
  [[nodiscard]] double variance(const Vec3& background) const;
  [[nodiscard]] double mean_luminance(const Vec3& background) const;  ///< as displayed

  [[nodiscard]] bool operator==(const PixelSum&) const = default;
};

/// Samples [first, last) of each pixel.
struct SampleRange {
  std::uint32_t first = 0, last = 0;

  [[nodiscard]] std::uint32_t size() const { return last - first; }
  [[nodiscard]] bool operator==(const SampleRange&) const = default;
};

/// The sums of a part of a picture.
class MICROTRACE_EXPORT SampleSums {
 public:
  SampleSums() = default;
  /// No samples of the pixels of `window` yet. Throws std::bad_alloc.
  SampleSums(ImageSize whole, const PixelRect& window, const Vec3& background);

  ImageSize whole;                 ///< size of the whole picture
  PixelRect window;                ///< the part with these sums
  Vec3 background{0};              ///< for luminance; black if the picture has alpha
  std::vector<PixelSum> pixels{};  ///< of the window, row by row from the upper left

  [[nodiscard]] PixelSum& at(std::uint32_t x, std::uint32_t y) { return pixels[index(x, y)]; }
  [[nodiscard]] const PixelSum& at(std::uint32_t x, std::uint32_t y) const {
    return pixels[index(x, y)];
  }

  /// The samples that were added, in order, possibly with gaps. Pixels that have converged only
  /// have the first of them.
  [[nodiscard]] const std::vector<SampleRange>& ranges() const { return ranges_; }
  /// The number of samples.
  [[nodiscard]] std::uint32_t count() const;
  /// The missing parts of `wanted`, in order.
  [[nodiscard]] std::vector<SampleRange> missing(const SampleRange& wanted) const;
  [[nodiscard]] bool overlaps(const SampleRange& range) const;
  /// Records samples that were added; they must not overlap others.
  void note(const SampleRange& range);

  /// Adds the samples of the same window of the same picture; none of them may be present.
  SampleSums& operator+=(const SampleSums& other);

 private:
  /// x and y are coordinates in the whole picture.
  [[nodiscard]] std::size_t index(std::uint32_t x, std::uint32_t y) const {
    return std::size_t{y - window.y0} * window.size().width + (x - window.x0);
  }

  std::vector<SampleRange> ranges_;
};

/// The picture of the samples so far, with alpha or over the background.
[[nodiscard]] MICROTRACE_EXPORT Film develop(const SampleSums& sums, Film::Alpha alpha);

}  // namespace microtrace
