#pragma once
/// The painters of a picture that a shutter divides into slices of time.

#include "render/samples/draw_at_random.hpp"
#include "render/samples/lit_view.hpp"
#include "render/samples/random_painter.hpp"

#include <microtrace/shutter.hpp>

#include <cstdint>
#include <optional>

namespace microtrace {

/// One painter for each slice. Holds the scene of the latest slice only. Without a shutter there is
/// one slice, the whole picture.
class Painters {
 public:
  /// The drawing must outlive this object.
  Painters(const RandomDrawing& drawing, ImageSize whole, const Vec3& background);

  [[nodiscard]] std::uint32_t slices() const { return slices_; }
  /// The least number of samples per pixel that a pass should take. Every pass makes the scene of
  /// each slice, so passes of several slices are long.
  [[nodiscard]] std::uint32_t least_pass() const;
  /// Returns the painter of a slice, which is valid until the next call.
  [[nodiscard]] const RandomPainter& at(std::uint32_t slice);

  /// The number of samples of all painters so far, and the number of those that were NaN.
  [[nodiscard]] std::uint64_t samples() const { return samples_ + painter_->samples(); }
  [[nodiscard]] std::uint64_t invalid_samples() const {
    return invalid_ + painter_->invalid_samples();
  }

 private:
  void open(std::uint32_t slice);

  const RandomDrawing& drawing_;
  ImageSize whole_;
  Vec3 background_;
  std::uint32_t slices_ = 1;
  std::optional<std::uint32_t> slice_{};  ///< absent before the first slice of a shutter
  std::optional<Moment> moment_{};
  std::optional<LitView> view_{};
  std::optional<RandomPainter> painter_{};
  std::uint64_t samples_ = 0, invalid_ = 0;  ///< of earlier painters
};

}  // namespace microtrace
