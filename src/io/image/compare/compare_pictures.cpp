#include "base/memory_account.hpp"
#include "base/system/float_environment.hpp"
#include "io/image/encode/eight_bits.hpp"

#include <microtrace/compare.hpp>
#include <microtrace/error.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace microtrace {
namespace {

void require_equal_sizes(const StoredPicture& a, const StoredPicture& b) {
  if (a.size.width == b.size.width && a.size.height == b.size.height) return;
  const auto text = [](ImageSize size) {
    return std::to_string(size.width) + " x " + std::to_string(size.height);
  };
  throw Error(ErrorKind::usage, "",
              "pictures of different sizes can't be compared: " + text(a.size) + " and " +
                  text(b.size) + " pixels");
}

/// Converts floats to 8 bits as save_image() does it.
StoredPicture with_eight_bits(const StoredPicture& picture, const Display& display) {
  Film film({.width = picture.size.width, .height = 1},
            picture.has_alpha ? Film::Alpha::premultiplied : Film::Alpha::none);
  film.display = display;
  StoredPicture result = picture;
  result.kind = StoredPicture::Samples::integers;
  const std::size_t channels = picture.has_alpha ? 4 : 3;
  std::vector<std::uint8_t> row(channels * picture.size.width);
  for (std::uint32_t y = 0; y < picture.size.height; ++y) {
    float* samples = &result.samples[std::size_t{4} * y * picture.size.width];
    for (std::uint32_t x = 0; x < picture.size.width; ++x) {
      const float* sample = samples + std::size_t{4} * x;
      film.at(x, 0) = Vec3(sample[0], sample[1], sample[2]);
      if (picture.has_alpha) film.alpha_at(x, 0) = sample[3];
    }
    io::encode_row(film, 0, row.data());
    for (std::uint32_t x = 0; x < picture.size.width; ++x) {
      for (std::size_t c = 0; c < channels; ++c)
        samples[std::size_t{4} * x + c] = static_cast<float>(row[channels * x + c]) / 255.0F;
    }
  }
  return result;
}

/// The absolute difference of two samples. That of integers is rounded only once, so that equal
/// differences of integers are equal numbers.
double difference_of(float a, float b, StoredPicture::Samples kind) {
  if (a == b || (std::isnan(a) && std::isnan(b))) return 0;
  // 65535 is a multiple of 255, so samples of 8 and 16 bits are multiples of 1 / 65535.
  constexpr double kMost = 65535;
  const bool is_integer = kind == StoredPicture::Samples::integers;
  const auto value = [&](double sample) {
    return is_integer ? std::round(sample * kMost) : sample;
  };
  const double difference = std::abs(value(a) - value(b)) / (is_integer ? kMost : 1);
  return std::isnan(difference) ? std::numeric_limits<double>::infinity() : difference;
}

/// Calls compare(a, b) with both pictures in the same kind of samples.
template <class Compare>
auto in_one_kind(const StoredPicture& a, const StoredPicture& b, const Display& display,
                 const Compare& compare) {
  require_equal_sizes(a, b);
  using enum StoredPicture::Samples;
  if (a.kind == b.kind) return compare(a, b);
  const MemoryAccount copy =
      temporary_memory(a.samples.size() * sizeof(float), "converting a picture to 8 bits");
  return a.kind == floats ? compare(with_eight_bits(a, display), b)
                          : compare(a, with_eight_bits(b, display));
}

PictureDifference compare(const StoredPicture& a, const StoredPicture& b, double threshold) {
  PictureDifference result{.pixels = a.samples.size() / 4};
  const std::size_t channels = a.has_alpha || b.has_alpha ? 4 : 3;
  double sum = 0, squares = 0;
  for (std::size_t pixel = 0; pixel < result.pixels; ++pixel) {
    const float* of_a = &a.samples[4 * pixel];
    const float* of_b = &b.samples[4 * pixel];
    double greatest = 0;
    for (std::size_t c = 0; c < channels; ++c) {
      const double difference = difference_of(of_a[c], of_b[c], a.kind);
      greatest = std::max(greatest, difference);
      sum += difference;
      squares += difference * difference;
    }
    const PixelPosition at{.x = static_cast<std::uint32_t>(pixel % a.size.width),
                           .y = static_cast<std::uint32_t>(pixel / a.size.width)};
    if (greatest > result.maximum) {
      result.maximum = greatest;
      result.at_maximum = at;
    }
    if (!(greatest > threshold)) continue;
    ++result.differing;
    if (result.first) continue;
    result.first = at;
    std::copy_n(of_a, 4, result.values[0].begin());
    std::copy_n(of_b, 4, result.values[1].begin());
  }
  const double count = static_cast<double>(channels) * static_cast<double>(result.pixels);
  result.mean = sum / count;
  result.root_mean_square = std::sqrt(squares / count);
  return result;
}

}  // namespace

PictureDifference compare_pictures(const StoredPicture& a, const StoredPicture& b, double threshold,
                                   const Display& display) {
  const FloatEnvironment environment;
  return in_one_kind(a, b, display, [&](const StoredPicture& x, const StoredPicture& y) {
    return compare(x, y, threshold);
  });
}

Film difference_picture(const StoredPicture& a, const StoredPicture& b, const Display& display) {
  const FloatEnvironment environment;
  constexpr float kAmplification = 8;
  return in_one_kind(a, b, display, [&](const StoredPicture& p, const StoredPicture& q) {
    take_memory(std::uint64_t{p.size.width} * p.size.height * sizeof(Vec3),
                "the difference of two pictures");
    Film film(p.size);
    for (std::uint32_t y = 0; y < p.size.height; ++y) {
      for (std::uint32_t x = 0; x < p.size.width; ++x) {
        const std::size_t first = 4 * (std::size_t{y} * p.size.width + x);
        const auto difference = [&](std::size_t c) {
          return static_cast<float>(
              difference_of(p.samples[first + c], q.samples[first + c], p.kind));
        };
        const float of_alpha = p.has_alpha || q.has_alpha ? difference(3) : 0;
        film.at(x, y) = glm::max(Vec3(difference(0), difference(1), difference(2)), of_alpha);
      }
    }
    film.display = {.srgb = false, .scale = Vec3(kAmplification)};
    return film;
  });
}

}  // namespace microtrace
