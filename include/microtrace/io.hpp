#pragma once
/// Reads scenes and environment maps, and writes pictures.

#include <microtrace/error.hpp>
#include <microtrace/export.hpp>
#include <microtrace/film.hpp>
#include <microtrace/memory.hpp>
#include <microtrace/scene.hpp>
#include <microtrace/scene_format.hpp>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace microtrace {

struct LoadedScene {
  Scene scene;
  /// Oddities, ignored features and repaired violations of the format (Severity::error), in file
  /// order.
  std::vector<Diagnostic> warnings;
  SceneFormat format = SceneFormat::json;
};

/// The surface attributes to load.
enum class SurfaceDetail {
  shape,  ///< loads normals, texture coordinates, and images whose alpha affects visibility;
          ///< sufficient for depth, ids and other quantities without color
  color,  ///< loads base colors, with images and texture coordinates; sufficient for flat pictures
  shape_and_color,  ///< loads all of shape and color; sufficient for albedo, and for flat pictures
                    ///< with AOVs
  all,    ///< loads everything that path tracing reads, including tangents and the images of all
          ///< textures except occlusion and thickness
  usual,  ///< color for JSON scenes, all for glTF assets, as the default integrators require
};

/// How meshes are stored that a scene contains several times.
enum class Instancing {
  automatic,  ///< shared if copies would have more than 2^20 triangles in all, otherwise copied
  shared,     ///< stored once; each object has a placement, see Mesh
  copied,     ///< transformed copies: faster rays, more memory
};

/// Loading times in seconds.
struct LoadTimes {
  double read = 0;      ///< reading the scene file, and buffers in files and data URIs
  double validate = 0;  ///< parsing and validating the file
  double bake = 0;      ///< decoding images and transforming vertices to world space
};

/// Options for loading a scene file.
struct LoadOptions {
  SurfaceDetail detail = SurfaceDetail::all;
  /// Material variant of a glTF asset (KHR_materials_variants), by name or by index counted from 0.
  /// Empty: the materials that the file assigns without variants.
  std::string variant{};
  /// Animation time of a glTF asset in seconds, clamped to the animation's range. Nothing: no
  /// animation is applied, and nodes have the transforms stored in the file.
  std::optional<double> time{};
  /// The animation to evaluate: its name, its index counted from 0, or "all" for all animations at
  /// once. Names take precedence. Empty: the first animation.
  std::string animation{};
  /// Additional folders from which a glTF asset may load buffers and images. Symbolic links to
  /// files of any scene may also lead into these folders.
  std::vector<std::filesystem::path> allowed_folders{};
  Instancing instancing = Instancing::automatic;  ///< results don't depend on it
  /// If true, refuses pipes and devices as scene files, whose reading might never end.
  bool needs_regular_file = false;
  LoadTimes* times = nullptr;  ///< if given, loading times are added to its members
  /// If given, counts the memory used for loading and for the loaded data. Must outlive the
  /// SceneFile and its scenes. The memory of a scene is counted until its SceneFile makes another
  /// scene or is destroyed.
  MemoryBudget* memory = nullptr;
};

/// Reads a scene file: microtrace JSON (.json) or glTF 2.0 (.gltf, .glb). For other extensions the
/// format is detected from the content. The path "-" reads standard input; paths in that scene are
/// relative to the current folder.
///
/// Throws Error: io if a file can't be read, invalid_scene if the scene violates its format,
/// unsupported if the scene requires an unsupported feature, usage if the variant or the animation
/// doesn't exist, limit if memory or another limit is exceeded.
[[nodiscard]] MICROTRACE_EXPORT LoadedScene load_scene(const std::filesystem::path& path,
                                                       const LoadOptions& options = {});

/// Reads a scene file whose bytes are in memory. Error messages use `name` as the file's name.
/// Paths in the scene are relative to `folder`. Throws Error as load_scene() does.
[[nodiscard]] MICROTRACE_EXPORT LoadedScene parse_scene(std::string_view bytes,
                                                        const std::string& name,
                                                        const std::filesystem::path& folder,
                                                        const LoadOptions& options = {});

/// What can be selected in a scene file by LoadOptions. JSON scenes have neither.
struct SceneChoices {
  struct Animation {
    std::string name;  ///< may be empty
    double end = 0;    ///< time of the last keyframe in seconds
  };
  std::vector<std::string> variants{};  ///< names, which may be empty
  std::vector<Animation> animations{};
};

/// A scene file that is read and checked once and can then be evaluated at many animation times.
/// For a JSON scene, the geometry of meshes is loaded again for each call of at().
class MICROTRACE_EXPORT SceneFile {
 public:
  /// Reads like load_scene(), but ignores options.time. Throws Error as load_scene() does.
  explicit SceneFile(const std::filesystem::path& path, LoadOptions options = {});
  ~SceneFile();
  SceneFile(SceneFile&& other) noexcept;
  SceneFile& operator=(SceneFile&& other) noexcept;

  [[nodiscard]] SceneFormat format() const;
  [[nodiscard]] SceneChoices choices() const;

  /// Returns the scene at an animation time, equal to the result of load_scene() with this
  /// options.time. Throws Error as load_scene() does, and Error (usage) for NaN.
  [[nodiscard]] LoadedScene at(std::optional<double> time);

  /// Does the same, and releases the memory that only further scenes would need. No other function
  /// may be called afterwards. The memory of the scene is still counted.
  [[nodiscard]] LoadedScene last(std::optional<double> time);

 private:
  struct MICROTRACE_HIDDEN Content;
  std::unique_ptr<Content> content_;
};

struct LoadedRadianceMap {
  std::shared_ptr<const RadianceMap> map;
  std::vector<Diagnostic> warnings;
};

/// Reads a latitude-longitude map by the module for OpenEXR (.exr) or OpenImageIO (other formats).
/// Integer samples (8 and 16 bits) are decoded as sRGB; floating-point samples (.hdr, .exr) are
/// linear. Colors are assumed to be Rec. 709. Single-channel maps are gray; alpha is ignored.
/// Negative values and NaN become 0, and values above kMaxRadiance become kMaxRadiance, with a
/// warning.
///
/// Throws Error: io if the file can't be read or decoded, limit for a side above 65536 pixels, more
/// than 2^27 pixels or lack of memory, unsupported if the module is not installed. `memory`, if
/// given, counts the map during its lifetime and must outlive it.
[[nodiscard]] MICROTRACE_EXPORT LoadedRadianceMap
load_radiance_map(const std::filesystem::path& path, MemoryBudget* memory = nullptr);

enum class PpmEncoding { binary, ascii };  ///< P6 or P3

/// A text file to be written together with a picture.
struct Sidecar {
  std::filesystem::path path;
  std::string text;
};

/// Writes a picture. The extension selects the format: the library writes .ppm itself, .png by
/// libpng, .exr by OpenEXR and other formats by OpenImageIO. Modules are loaded when needed. The
/// path "-" writes PPM to standard output.
///
/// Float formats (.exr, .hdr) store the film's values; other formats store 8 bits per sample
/// according to film.display. Colors are premultiplied with alpha in float formats and unassociated
/// in others. Only .exr stores channels besides colors, and the position of a crop in the whole
/// picture. The file appears whole or not at all. A sidecar is completely written before either
/// file replaces its target.
///
/// Throws Error: usage if the extension is unknown or the format can't store the film's contents,
/// io if a file can't be written or encoded, unsupported if the format's module is not installed,
/// limit if the module can't start its threads.
MICROTRACE_EXPORT void save_image(const Film& film, const std::filesystem::path& path,
                                  PpmEncoding ppm = PpmEncoding::binary,
                                  const Sidecar* sidecar = nullptr);

/// What a film contains besides colors.
struct FilmContents {
  bool alpha = false;
  bool channels = false;
  std::optional<ImageSize> size{};  ///< if known
};

/// Throws the Error with which save_image() would fail at once for this path and a film with these
/// contents. Writes nothing. Call this function before a long rendering.
MICROTRACE_EXPORT void check_image_path(const std::filesystem::path& path,
                                        const FilmContents& contents = {});

/// Throws the Error with which save_image() would fail at once for a sidecar at this path. Writes
/// nothing.
MICROTRACE_EXPORT void check_sidecar_path(const std::filesystem::path& path,
                                          const std::filesystem::path& picture);

/// Removes the temporary files of pictures that are being saved, and temporary folders. May be
/// called in a signal handler that then ends the process.
MICROTRACE_EXPORT void remove_unfinished_files() noexcept;

/// Returns the bytes of a PPM file. Throws Error (usage) for a film with alpha.
[[nodiscard]] MICROTRACE_EXPORT std::string encode_ppm(const Film& film,
                                                       PpmEncoding ppm = PpmEncoding::binary);

}  // namespace microtrace
