#pragma once
/// The set of pixels that an object covers in a picture.

#include <microtrace/camera.hpp>
#include <microtrace/film.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace microtrace::dataset {

/// The pixels [x0, x1) of row y.
struct PixelRun {
  std::uint32_t y = 0, x0 = 0, x1 = 0;

  [[nodiscard]] bool operator==(const PixelRun&) const = default;
};

/// A set of pixels. It stores runs of pixels in rows, so its memory is proportional to its outline.
class Mask {
 public:
  /// Adds a pixel. Pixels must be added row by row, and from left to right in each row.
  void add(std::uint32_t x, std::uint32_t y);

  /// The pixels in order. Runs neither overlap nor touch.
  [[nodiscard]] const std::vector<PixelRun>& runs() const { return runs_; }
  /// Returns the number of pixels.
  [[nodiscard]] std::uint64_t area() const { return area_; }
  /// The bounding box. All 0 if the mask is empty.
  [[nodiscard]] const PixelRect& box() const { return box_; }

 private:
  std::vector<PixelRun> runs_;
  std::uint64_t area_ = 0;
  PixelRect box_;
};

/// Returns the run lengths of a mask in the order of COCO: column by column, beginning with the
/// number of pixels outside the mask, which may be 0. Their sum is the number of pixels of the
/// picture.
[[nodiscard]] std::vector<std::uint64_t> column_counts(const Mask& mask, ImageSize size);

/// Encodes run lengths as the `counts` string of COCO's compressed run-length encoding: the
/// differences to the run lengths two places before, from the fourth on, in groups of five bits,
/// lowest first; 32 marks groups before the last one, and 48 is added to make characters.
[[nodiscard]] std::string compressed_counts(const std::vector<std::uint64_t>& counts);

}  // namespace microtrace::dataset
