#pragma once
/// Annotations of pictures in the JSON format of COCO for object detection and instance
/// segmentation (https://cocodataset.org/#format-data). docs/datasets.md describes their members.

#include <microtrace/camera.hpp>
#include <microtrace/export.hpp>
#include <microtrace/prepared_scene.hpp>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace microtrace {

/// The property of objects that determines their category.
enum class CocoCategories { objects, materials };

struct CocoOptions {
  CocoCategories categories = CocoCategories::objects;
  /// Adds masks of the pixels in which an object would be visible without the other objects.
  bool amodal = false;
  unsigned threads = 0;  ///< for amodal masks; 0: default_threads()
};

/// A picture of a prepared scene.
struct CocoPicture {
  std::uint32_t index = 0;  ///< id of the image
  std::string file{};       ///< name of the picture's file
  Camera camera{};          ///< in scene coordinates, as in Scene::cameras
  ImageSize size{};
  /// The values of the channel id.instance, row by row: 0 where nothing is visible, else the
  /// object's index plus 1.
  std::span<const std::uint32_t> ids{};
};

/// Returns the annotations of one picture for join_coco(). Throws Error: usage if `ids` doesn't
/// have one value per pixel; limit if memory runs out.
[[nodiscard]] MICROTRACE_EXPORT std::string coco_annotations(const PreparedScene& scene,
                                                             const CocoPicture& picture,
                                                             const CocoOptions& options = {});

/// Joins the results of coco_annotations(), stored in the files parts[i], into one file. Numbers
/// the annotations from 1 in the order of the parts. Keeps one part in memory at a time. The
/// categories are those of `scene`. Throws Error (io).
MICROTRACE_EXPORT void join_coco(std::span<const std::filesystem::path> parts, const Scene& scene,
                                 CocoCategories categories, const std::filesystem::path& output);

}  // namespace microtrace
