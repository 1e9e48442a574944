#pragma once
/// What is known of a picture whose samples come in parts: from several passes over it, several
/// runs of the program, several machines.

#include <microtrace/export.hpp>
#include <microtrace/film.hpp>
#include <microtrace/fixed_sum.hpp>
#include <microtrace/math.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace microtrace {

/// Light beyond this counts as this. A pixel has at most 2^16 samples: their sum stays below 2^62.
inline constexpr double kMaxSampleLight = 0x1p46;

/// The samples of one pixel together. Sums are exact on multiples of 2^-64 (alpha 2^-46, squares
/// 2^-80), so that the same samples give the same bits in any order and grouping.
struct MICROTRACE_EXPORT PixelSum {
  std::array<FixedSum<2, 64>, 3> color{};
  FixedSum<1, 46> alpha{};
  FixedSum<3, 80> square{};  ///< of the luminance that is shown
  std::uint32_t count = 0;   ///< of samples

  /// A sample as an integrator gives it, over that background. Returns false, and counts it as
  /// black, if it is not a number.
  bool add(const Vec3& sample, float sample_alpha, const Vec3& background);

  PixelSum& operator+=(const PixelSum& other);

  [[nodiscard]] Vec3 mean_color() const;   ///< black if there is no sample
  [[nodiscard]] float mean_alpha() const;  ///< 0 if there is no sample
  /// The estimated variance of the mean of the luminance shown, from the samples' own: what
  /// independent samples would have, more than that of well-spread ones. 0 for less than two.
  [[nodiscard]] double variance(const Vec3& background) const;
  [[nodiscard]] double mean_luminance(const Vec3& background) const;  ///< that is shown

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
  /// No samples yet of the pixels of `window`. Throws std::bad_alloc.
  SampleSums(ImageSize whole, const PixelRect& window, const Vec3& background);

  ImageSize whole;     ///< the picture
  PixelRect window;    ///< the part of it whose sums these are
  Vec3 background{0};  ///< over which luminance is taken; black where the picture has alpha
  std::vector<PixelSum> pixels{};  ///< of the window, row by row from the upper left

  [[nodiscard]] PixelSum& at(std::uint32_t x, std::uint32_t y) { return pixels[index(x, y)]; }
  [[nodiscard]] const PixelSum& at(std::uint32_t x, std::uint32_t y) const {
    return pixels[index(x, y)];
  }

  /// Which samples are there; in order, with gaps between. Pixels that needed no more have only
  /// the first of them.
  [[nodiscard]] const std::vector<SampleRange>& ranges() const { return ranges_; }
  /// Their number.
  [[nodiscard]] std::uint32_t count() const;
  /// The parts of `wanted` that are not there, in order.
  [[nodiscard]] std::vector<SampleRange> missing(const SampleRange& wanted) const;
  [[nodiscard]] bool overlaps(const SampleRange& range) const;
  /// Notes that samples were added, which do not overlap those that are there.
  void note(const SampleRange& range);

  /// Adds the samples of the same window of the same picture, of which none is here yet.
  SampleSums& operator+=(const SampleSums& other);

 private:
  /// x and y are the whole picture's.
  [[nodiscard]] std::size_t index(std::uint32_t x, std::uint32_t y) const {
    return std::size_t{y - window.y0} * window.size().width + (x - window.x0);
  }

  std::vector<SampleRange> ranges_;
};

/// The picture of the samples that are there, with alpha or over the background.
[[nodiscard]] MICROTRACE_EXPORT Film develop(const SampleSums& sums, Film::Alpha alpha);

}  // namespace microtrace
