#include "render/samples/painters.hpp"

#include <memory>

namespace microtrace {

Painters::Painters(const RandomDrawing& drawing, ImageSize whole, const Vec3& background)
    : drawing_(drawing), whole_(whole), background_(background) {
  if (const std::optional<Shutter>& shutter = drawing.options.shutter)
    slices_ = shutter->times.slices();
  painter_.emplace(drawing.world, drawing.integrator, drawing.options, background);
}

std::uint32_t Painters::least_pass() const {
  if (slices_ == 1) return 1;
  return drawing_.options.passes ? slices_ : kMaxSamples;
}

const RandomPainter& Painters::at(std::uint32_t slice) {
  if (drawing_.options.shutter && slice_ != slice) open(slice);
  return *painter_;
}

void Painters::open(std::uint32_t slice) {
  samples_ += painter_->samples();
  invalid_ += painter_->invalid_samples();
  // The next scene is made after this one is destroyed, so that only one takes memory.
  slice_.reset();
  painter_.emplace(drawing_.world, drawing_.integrator, drawing_.options, background_);
  view_.reset();
  moment_.reset();
  const Shutter& shutter = *drawing_.options.shutter;
  moment_.emplace(shutter.moment(shutter.times.time(slice)));
  const std::shared_ptr<const PreparedScene::Content> content(std::shared_ptr<void>(),
                                                              &moment_->scene.content());
  const auto shown = content_for(content, moment_->camera, whole_);
  view_.emplace(near_origin(shown, moment_->camera, whole_), drawing_.options);
  painter_.emplace(view_->world(), drawing_.integrator, drawing_.options, background_,
                   sampling::TimeSlice{.index = slice, .count = slices_});
  slice_ = slice;
}

}  // namespace microtrace
