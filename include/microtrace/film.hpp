#pragma once
/// The picture being made.

#include <microtrace/camera.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace microtrace {

/// width x height linear Rec. 709 colours, row by row from the upper left.
class Film {
 public:
  explicit Film(ImageSize size) : size_(size), pixels_(std::size_t{size.width} * size.height) {}

  [[nodiscard]] ImageSize size() const { return size_; }
  [[nodiscard]] Vec3& at(std::uint32_t x, std::uint32_t y) {
    return pixels_[std::size_t{y} * size_.width + x];
  }
  [[nodiscard]] std::span<const Vec3> row(std::uint32_t y) const {
    return std::span(pixels_).subspan(std::size_t{y} * size_.width, size_.width);
  }

 private:
  ImageSize size_;
  std::vector<Vec3> pixels_;
};

}  // namespace microtrace
