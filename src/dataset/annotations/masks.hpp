#pragma once
/// The masks of all objects of a view.

#include "dataset/annotations/drawn_view.hpp"
#include "dataset/annotations/mask.hpp"

#include <microtrace/queries.hpp>

#include <cstdint>
#include <vector>

namespace microtrace::dataset {

struct ObjectMask {
  std::uint32_t object = 0;  ///< index in Scene::objects
  Mask mask;
};

/// Masks in the order of the objects. Objects without pixels are left out.
using Masks = std::vector<ObjectMask>;

/// Returns the object's mask, or null if it has no pixels.
[[nodiscard]] const Mask* find_mask(const Masks& masks, std::uint32_t object);

/// Returns the pixels in which each object is visible. Throws Error (usage) if view.objects doesn't
/// have one value per pixel, or if the scene has fewer objects.
[[nodiscard]] Masks visible_masks(const DrawnView& view);

/// Returns the amodal masks: the pixels in which each object would be visible without the other
/// objects. The ray through the pixel's center hits the object at a point that is neither a culled
/// back face nor removed by an alpha mask; other surfaces may be in front of it. The visible mask
/// is a part of the amodal mask. Pixels outside the picture don't count. The memory needed is that
/// of the masks and of the hits of some 65 000 pixels. Throws Error: usage as visible_masks(),
/// limit if memory runs out, canceled if options.progress returns false.
[[nodiscard]] Masks amodal_masks(const DrawnView& view, const QueryOptions& options = {});

}  // namespace microtrace::dataset
