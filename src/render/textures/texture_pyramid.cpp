#include "render/textures/texture_pyramid.hpp"

#include "scene/math/srgb.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <variant>

namespace microtrace {
namespace {

/// Makes the table of the linear values of all `Count` sample values.
template <std::size_t Count>
std::array<float, Count> make_table(ColorEncoding encoding) {
  std::array<float, Count> table;
  for (std::size_t i = 0; i < Count; ++i) {
    const double value = static_cast<double>(i) / (Count - 1);
    table[i] =
        static_cast<float>(encoding == ColorEncoding::srgb ? linear_from_srgb(value) : value);
  }
  return table;
}

std::span<const float> table(bool is_wide, ColorEncoding encoding) {
  static const auto srgb8 = make_table<256>(ColorEncoding::srgb);
  static const auto linear8 = make_table<256>(ColorEncoding::linear);
  if (!is_wide) return encoding == ColorEncoding::srgb ? srgb8 : linear8;
  static const auto srgb16 = make_table<65536>(ColorEncoding::srgb);
  static const auto linear16 = make_table<65536>(ColorEncoding::linear);
  return encoding == ColorEncoding::srgb ? srgb16 : linear16;
}

/// The pixels of the finer level that a pixel of a mip map covers along one axis, at most three.
struct Cover {
  std::uint32_t first = 0, count = 0;
  std::array<double, 3> weights{};
};

/// Computes the cover of pixel i of m = n / 2 pixels, which is [i n / m, (i + 1) n / m) of the n
/// finer pixels.
Cover cover(std::uint32_t i, std::uint32_t n) {
  const std::uint32_t m = std::max(n / 2, 1U);
  const double begin = double{1} * i * n / m, end = double{1} * (i + 1) * n / m;
  Cover result{.first = static_cast<std::uint32_t>(begin)};
  for (std::uint32_t x = result.first; x < end && x < n && result.count < 3; ++x) {
    const double part = std::min(end, x + 1.0) - std::max(begin, double{1} * x);
    result.weights[result.count++] = part / (end - begin);
  }
  return result;
}

}  // namespace

TexturePyramid::TexturePyramid(std::shared_ptr<const Image> image, ColorEncoding encoding)
    : image_(std::move(image)), memory_(memory_account().budget()) {
  const bool is_wide = std::holds_alternative<std::vector<std::uint16_t>>(image_->samples);
  color_table_ = table(is_wide, encoding);
  alpha_table_ = table(is_wide, ColorEncoding::linear);
}

const std::vector<TexturePyramid::Level>& TexturePyramid::levels() {
  if (levels_.empty() && (image_->width > 1 || image_->height > 1)) make_levels();
  return levels_;
}

void TexturePyramid::make_levels() {
  std::uint64_t pixels = 0;
  for (std::uint64_t width = image_->width, height = image_->height; width > 1 || height > 1;) {
    width = std::max(width / 2, std::uint64_t{1});
    height = std::max(height / 2, std::uint64_t{1});
    pixels += width * height;
  }
  memory_.take(pixels * 4 * sizeof(std::uint16_t), "the mip maps of images");
  DVec2 size = level_size(0);
  while (size.x > 1 || size.y > 1) {
    const auto width = static_cast<std::uint32_t>(size.x);
    const auto height = static_cast<std::uint32_t>(size.y);
    const std::size_t finer = levels_.size();
    Level level{.width = std::max(width / 2, 1U), .height = std::max(height / 2, 1U)};
    if (width % 2 == 0 && height % 2 == 0) {
      halve(finer, level);
      levels_.push_back(std::move(level));
      size = level_size(levels_.size());
      continue;
    }
    level.samples.reserve(std::size_t{level.width} * level.height * 4);
    std::vector<Cover> columns;
    for (std::uint32_t x = 0; x < level.width; ++x) columns.push_back(cover(x, width));
    for (std::uint32_t y = 0; y < level.height; ++y) {
      const Cover rows = cover(y, height);
      for (const Cover& column : columns) {
        DVec4 sum(0.5);  // makes the conversion to integers round to nearest
        for (std::uint32_t j = 0; j < rows.count; ++j) {
          for (std::uint32_t i = 0; i < column.count; ++i) {
            sum += rows.weights[j] * column.weights[i] * 65535.0 *
                   pixel(finer, column.first + i, rows.first + j);
          }
        }
        for (glm::length_t c = 0; c < 4; ++c) {
          level.samples.push_back(static_cast<std::uint16_t>(std::min(sum[c], 65535.0)));
        }
      }
    }
    levels_.push_back(std::move(level));
    size = level_size(levels_.size());
  }
}

namespace {

/// Four numbers in SIMD registers, because GLM would compute them one by one.
typedef double FourDoubles __attribute__((vector_size(32)));

/// Computes a level of exactly half the size. add(x, y, sum) adds a pixel of the finer level,
/// multiplied by kQuarterOfMost, to the sum.
constexpr double kQuarterOfMost = 0.25 * 65535.0;
template <class Add>
void halve_lines(std::uint32_t width, std::uint32_t height, const Add& add,
                 std::vector<std::uint16_t>& samples) {
  samples.resize(std::size_t{width} * height * 4);
  std::uint16_t* to = samples.data();
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      FourDoubles sum = FourDoubles{} + 0.5;  // makes the conversion to integers round to nearest
      add(2 * x, 2 * y, sum);
      add(2 * x + 1, 2 * y, sum);
      add(2 * x, 2 * y + 1, sum);
      add(2 * x + 1, 2 * y + 1, sum);
      for (int c = 0; c < 4; ++c) *to++ = static_cast<std::uint16_t>(std::min(sum[c], 65535.0));
    }
  }
}

}  // namespace

void TexturePyramid::halve(std::size_t finer, Level& level) const {
  const std::size_t columns = std::size_t{2} * level.width;
  if (finer > 0) {
    const std::uint16_t* from = levels_[finer - 1].samples.data();
    const auto add = [=](std::size_t x, std::size_t y, FourDoubles& sum) {
      const std::uint16_t* s = from + (y * columns + x) * 4;
      sum += kQuarterOfMost *
             (FourDoubles{double(s[0]), double(s[1]), double(s[2]), double(s[3])} * (1 / 65535.0));
    };
    return halve_lines(level.width, level.height, add, level.samples);
  }
  const float *color = color_table_.data(), *alpha = alpha_table_.data();
  std::visit(
      [&](const auto& samples) {
        const auto halve_from = [&]<std::size_t channels>() {
          const auto* from = samples.data();
          const auto add = [=](std::size_t x, std::size_t y, FourDoubles& sum) {
            const auto* s = from + (y * columns + x) * channels;
            const double a = channels % 2 == 0 ? alpha[s[channels - 1]] : 1;
            constexpr int kGreen = channels < 3 ? 0 : 1, kBlue = channels < 3 ? 0 : 2;
            sum += kQuarterOfMost * FourDoubles{color[s[0]], color[s[kGreen]], color[s[kBlue]], a};
          };
          halve_lines(level.width, level.height, add, level.samples);
        };
        switch (image_->channels) {
          case 1:
            return halve_from.template operator()<1>();
          case 2:
            return halve_from.template operator()<2>();
          case 3:
            return halve_from.template operator()<3>();
          default:
            return halve_from.template operator()<4>();
        }
      },
      image_->samples);
}

DVec2 TexturePyramid::level_size(std::size_t level) const {
  if (level == 0) return {image_->width, image_->height};
  return {levels_[level - 1].width, levels_[level - 1].height};
}

DVec4 TexturePyramid::image_pixel(std::uint32_t x, std::uint32_t y) const {
  return std::visit(
      [&](const auto& samples) -> DVec4 {
        const std::size_t channels = image_->channels;
        const auto* s = &samples[(std::size_t{y} * image_->width + x) * channels];
        const double alpha = channels % 2 == 0 ? alpha_table_[s[channels - 1]] : 1;
        if (channels < 3) return {DVec3(color_table_[s[0]]), alpha};
        return {color_table_[s[0]], color_table_[s[1]], color_table_[s[2]], alpha};
      },
      image_->samples);
}

DVec4 TexturePyramid::pixel(std::size_t level, std::uint32_t x, std::uint32_t y) const {
  if (level == 0) return image_pixel(x, y);
  const Level& mip = levels_[level - 1];
  const std::uint16_t* s = &mip.samples[(std::size_t{y} * mip.width + x) * 4];
  return DVec4(s[0], s[1], s[2], s[3]) * (1 / 65535.0);
}

}  // namespace microtrace
