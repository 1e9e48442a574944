#pragma once
/// Annotations for the estimation of object poses in the format of BOP
/// (https://github.com/thodan/bop_toolkit, docs/bop_datasets_format.md).

#include "dataset/annotations/drawn_view.hpp"
#include "dataset/annotations/masks.hpp"

#include <microtrace/annotations.hpp>
#include <microtrace/math.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace microtrace::dataset {

struct BopOptions {
  double millimeters_per_unit = 1000;  ///< the length of a unit of the scene
  double depth_scale = 0.1;            ///< millimeters per step of the depth pictures
  std::uint32_t first_object_id = 1;   ///< obj_id of the scene's first object
};

/// The positions of a scene's objects, for all its views.
class BopFrames {
 public:
  explicit BopFrames(const Scene& scene);

  /// The origin of the object's model, in scene coordinates: the center of the bounding box of a
  /// mesh or triangle, and (0, 0, 0) for other shapes. The model's axes are those of world space.
  [[nodiscard]] const DVec3& origin(std::size_t object) const { return origins_[object]; }

 private:
  std::vector<DVec3> origins_;
};

/// Returns a view's annotations. The view's index is the im_id. All objects with an amodal mask are
/// annotated, in their order. Throws Error: usage if the camera is neither a perspective camera nor
/// a calibrated camera without distortion, for scales that are not positive, or if view.depth
/// doesn't have one value per pixel; unsupported if there is no codec module.
[[nodiscard]] BopAnnotations bop_view(const DrawnView& view, const BopFrames& frames,
                                      const Masks& visible, const Masks& amodal,
                                      const BopOptions& options = {});

/// The JSON files of a BOP scene.
enum class BopFile { scene_camera, scene_gt, scene_gt_info };

/// Passes a JSON file for the parts of `count` views to `out`. Calls part(i) once for each i, in
/// order, and keeps one part in memory at a time. Throws Error (io) if a part is incomplete.
void join_bop(BopFile file, std::size_t count, const std::function<std::string(std::size_t)>& part,
              const std::function<void(std::string_view)>& out);

}  // namespace microtrace::dataset
