#pragma once
/// The input of annotation formats: a view whose ids and depths are rendered.

#include <microtrace/camera.hpp>
#include <microtrace/prepared_scene.hpp>

#include <cstdint>
#include <span>
#include <string>

namespace microtrace::dataset {

/// The value of DrawnView::objects where nothing is visible.
inline constexpr std::uint32_t kNoObject = 0xFFFFFFFF;

/// A rendered view. What the pointers and spans refer to must outlive the view.
struct DrawnView {
  std::uint32_t index = 0;  ///< of the view in its data set
  const PreparedScene* scene = nullptr;
  const Camera* camera = nullptr;  ///< in scene coordinates, as in Scene::cameras
  ImageSize size;
  /// For each pixel, row by row, the index of the visible object in Scene::objects, or kNoObject.
  std::span<const std::uint32_t> objects;
  std::span<const float> depth;  ///< Aov::depth, row by row
  std::string color_file;        ///< relative path of the color picture; may be empty
};

}  // namespace microtrace::dataset
