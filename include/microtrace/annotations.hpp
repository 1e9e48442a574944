#pragma once
/// Annotations of pictures in the formats of COCO (https://cocodataset.org/#format-data) and BOP
/// (https://github.com/thodan/bop_toolkit), and pictures as arrays of NumPy. docs/datasets.md
/// describes the files.

#include <microtrace/camera.hpp>
#include <microtrace/error.hpp>
#include <microtrace/export.hpp>
#include <microtrace/film.hpp>
#include <microtrace/prepared_scene.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace microtrace {

/// A picture of a prepared scene.
struct AnnotatedPicture {
  std::uint32_t index = 0;  ///< id of the image
  std::string file{};       ///< name of the picture's file, for COCO; empty if there is none
  Camera camera{};          ///< in scene coordinates, as in Scene::cameras
  ImageSize size{};
  /// The values of the channel id.instance, row by row: 0 where nothing is visible, else the
  /// object's index plus 1.
  std::span<const std::uint32_t> ids{};
  std::span<const float> depth{};  ///< the values of the channel depth.Z, for BOP
};

/// The property of objects that determines their category.
enum class CocoCategories { objects, materials };

struct CocoOptions {
  CocoCategories categories = CocoCategories::objects;
  /// Adds masks of the pixels in which an object would be visible without the other objects.
  bool amodal = false;
};

/// Joins Annotations::coco, stored in the files parts[i], into one file. Numbers
/// the annotations from 1 in the order of the parts. Keeps one part in memory at a time. The first
/// categories are those of `scene`; those that other views add, by variants or animations, follow.
/// Throws Error (io).
MICROTRACE_EXPORT void join_coco(std::span<const std::filesystem::path> parts, const Scene& scene,
                                 CocoCategories categories, const std::filesystem::path& output);

/// A file in memory.
struct NamedFile {
  std::string name;  ///< relative to some folder, separated by /
  std::string bytes;
};

/// The annotations of one picture for BOP.
struct BopAnnotations {
  std::string part;              ///< for join_bop()
  std::vector<NamedFile> files;  ///< depth, mask and mask_visib, relative to the scene's folder
  std::optional<Diagnostic> too_far, too_near;  ///< warnings about depths that are stored as 0
};

/// The formats that annotate() makes.
struct AnnotationFormats {
  std::optional<CocoOptions> coco{};
  /// The step in which BOP stores depths, in millimeters. A unit of the scene is a meter.
  std::optional<double> bop_depth_scale{};
};

/// The annotations of one picture. Formats that were not requested are empty.
struct Annotations {
  std::string coco;  ///< for join_coco()
  BopAnnotations bop;
};

/// Throws Error (usage), with `place` as its file, if BOP can't describe the camera: if it is
/// neither a perspective camera nor a calibrated camera without distortion.
MICROTRACE_EXPORT void require_bop_camera(const Camera& camera, const std::string& place);

/// Makes the annotations of one picture. In BOP, the picture's index is the im_id. Throws Error:
/// usage if `ids` or, for BOP, `depth` doesn't have one value per pixel, or as require_bop_camera()
/// does; unsupported if BOP is requested but the module for PNG is not installed; limit if memory
/// runs out.
[[nodiscard]] MICROTRACE_EXPORT Annotations annotate(const PreparedScene& scene,
                                                     const AnnotatedPicture& picture,
                                                     const AnnotationFormats& formats,
                                                     unsigned threads = 0);

/// Joins BopAnnotations::part, stored in the files parts[i], into scene_camera.json, scene_gt.json
/// and scene_gt_info.json in `folder`. Keeps one part in memory at a time. Throws Error (io).
MICROTRACE_EXPORT void join_bop(std::span<const std::filesystem::path> parts,
                                const std::filesystem::path& folder);

/// Returns the models of the scene's meshes and triangles and models_info.json.
[[nodiscard]] MICROTRACE_EXPORT std::vector<NamedFile> bop_models(const Scene& scene);

/// Returns a film as a .npz file: the array `color` of shape (height, width, 3), or 4 with
/// premultiplied alpha, in linear Rec. 709, and an array for each group of channels. The group's
/// name precedes the dot of the channels' names. Its shape is (height, width), or (height, width,
/// number of channels). Throws Error (limit) for more than 4 GiB.
[[nodiscard]] MICROTRACE_EXPORT std::string npz_of(const Film& film);

}  // namespace microtrace
