#include "base/system/float_environment.hpp"
#include "render/film/add_sample.hpp"
#include "render/film/film_pixel.hpp"
#include "render/film/sum_samples.hpp"
#include "scene/math/luminance.hpp"

#include <microtrace/sample_sums.hpp>

#include <algorithm>
#include <cmath>

namespace microtrace {

bool add_sample(PixelSum& sum, const Vec3& sample, float sample_alpha, const Vec3& background) {
  auto& [color, alpha, square, count] = sum;
  ++count;
  const bool is_number = !std::isnan(sample.x) && !std::isnan(sample.y) && !std::isnan(sample.z) &&
                         !std::isnan(sample_alpha);
  if (!is_number) {
    alpha.add(1);
    return false;
  }
  const SampleTerms<1> terms =
      sample_terms<1>({sample.x, sample.y, sample.z}, sample_alpha,
                      {background.x, background.y, background.z}, kMaxSampleLight);
  for (std::size_t c = 0; c < color.size(); ++c) color[c].add(terms.color[c]);
  alpha.add(terms.alpha);
  square.add(terms.square);
  return true;
}

bool PixelSum::add(const Vec3& sample, float sample_alpha, const Vec3& background) {
  const FloatEnvironment environment;
  return add_sample(*this, sample, sample_alpha, background);
}

PixelSum& PixelSum::operator+=(const PixelSum& other) {
  for (std::size_t c = 0; c < color.size(); ++c) color[c] += other.color[c];
  alpha += other.alpha;
  square += other.square;
  count += other.count;
  return *this;
}

Vec3 PixelSum::mean_color() const {
  const FloatEnvironment environment;
  if (count == 0) return Vec3(0);
  const auto n = static_cast<double>(count);
  return {static_cast<float>(color[0].value() / n), static_cast<float>(color[1].value() / n),
          static_cast<float>(color[2].value() / n)};
}

float PixelSum::mean_alpha() const {
  const FloatEnvironment environment;
  return count == 0 ? 0 : static_cast<float>(alpha.value() / count);
}

double PixelSum::mean_luminance(const Vec3& background) const {
  const FloatEnvironment environment;
  if (count == 0) return 0;
  const DVec3 sum(color[0].value(), color[1].value(), color[2].value());
  const auto n = static_cast<double>(count);
  return luminance(sum / n + (1 - alpha.value() / n) * DVec3(background));
}

double PixelSum::variance(const Vec3& background) const {
  const FloatEnvironment environment;
  if (count < 2) return 0;
  const auto n = static_cast<double>(count);
  const double mean = mean_luminance(background);
  return std::max(square.value() / n - mean * mean, 0.0) / (n - 1);
}

SampleSums::SampleSums(ImageSize whole_picture, const PixelRect& part, const Vec3& behind)
    : whole(whole_picture),
      window(part),
      background(behind),
      pixels(std::size_t{part.size().width} * part.size().height) {}

std::uint32_t SampleSums::count() const {
  std::uint32_t count = 0;
  for (const SampleRange& range : ranges_) count += range.size();
  return count;
}

std::vector<SampleRange> SampleSums::missing(const SampleRange& wanted) const {
  std::vector<SampleRange> result;
  std::uint32_t first = wanted.first;
  for (const SampleRange& range : ranges_) {
    if (range.first >= wanted.last) break;
    if (range.first > first) result.push_back({.first = first, .last = range.first});
    first = std::max(first, range.last);
  }
  if (first < wanted.last) result.push_back({.first = first, .last = wanted.last});
  return result;
}

bool SampleSums::overlaps(const SampleRange& range) const {
  return std::ranges::any_of(ranges_, [&](const SampleRange& there) {
    return std::max(there.first, range.first) < std::min(there.last, range.last);
  });
}

void SampleSums::note(const SampleRange& range) {
  if (range.size() == 0) return;
  ranges_.insert(std::ranges::lower_bound(ranges_, range.first, {}, &SampleRange::first), range);
  std::vector<SampleRange> joined;
  for (const SampleRange& next : ranges_) {
    if (!joined.empty() && joined.back().last == next.first) {
      joined.back().last = next.last;
    } else {
      joined.push_back(next);
    }
  }
  ranges_ = std::move(joined);
}

SampleSums& SampleSums::operator+=(const SampleSums& other) {
  for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] += other.pixels[i];
  for (const SampleRange& range : other.ranges()) note(range);
  return *this;
}

Film develop(const SampleSums& sums, Film::Alpha alpha) {
  const FloatEnvironment environment;
  const ImageSize size = sums.window.size();
  Film film(size, alpha);
  film.whole = sums.whole;
  film.x0 = sums.window.x0;
  film.y0 = sums.window.y0;
  for (std::uint32_t y = 0; y < size.height; ++y) {
    for (std::uint32_t x = 0; x < size.width; ++x) {
      const PixelSum& pixel = sums.at(film.x0 + x, film.y0 + y);
      set_pixel(film, x, y, pixel.mean_color(), pixel.mean_alpha(), sums.background);
    }
  }
  return film;
}

}  // namespace microtrace
