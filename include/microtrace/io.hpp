#pragma once
/// Reading scenes, reading environment maps, and writing pictures.

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
  /// In file order: oddities, features without effect, and repaired violations of the format
  /// (Severity::error).
  std::vector<Diagnostic> warnings;
  SceneFormat format = SceneFormat::json;
};

/// The surface attributes to load.
enum class SurfaceDetail {
  shape,  ///< normals, texture coordinates, and images whose alpha affects visibility: for depth,
          ///< ids and other quantities without color
  color,  ///< base colors with their images and texture coordinates: for flat pictures
  shape_and_color,  ///< both: for albedo, and for flat pictures with AOVs
  all,    ///< what path tracing reads: also tangents, and images of all textures but occlusion and
          ///< thickness
  usual,  ///< color for JSON scenes, all for glTF assets: the needs of the default integrators
};

/// Loading times in seconds.
struct LoadTimes {
  double read = 0;      ///< reading the scene file, and buffers in files and data URIs
  double validate = 0;  ///< parsing and validating
  double bake = 0;      ///< decoding images and transforming vertices to world space
};

/// Options for loading a scene file.
struct LoadOptions {
  SurfaceDetail detail = SurfaceDetail::all;
  /// Material variant of a glTF asset (KHR_materials_variants), by name or by index from 0. Empty:
  /// the materials assigned in the file.
  std::string variant{};
  /// Animation time of a glTF asset in seconds, clamped to the animation's range. Nothing: the pose
  /// stored in the file.
  std::optional<double> time{};
  /// The animation to evaluate, by name, by index from 0, or "all" for all at once; names take
  /// precedence. Empty: the first.
  std::string animation{};
  /// Additional folders from which a glTF asset may load buffers and images, and to which symbolic
  /// links of any scene's files may lead.
  std::vector<std::filesystem::path> allowed_folders{};
  LoadTimes* times = nullptr;  ///< if given, loading times are added
  /// If given, counts the memory of loading and of the loaded data. Must outlive the SceneFile and
  /// its scenes. The memory of a scene is counted until its SceneFile makes another scene or is
  /// destroyed.
  MemoryBudget* memory = nullptr;
};

/// Reads a scene file: microtrace JSON (.json) or glTF 2.0 (.gltf, .glb); for other extensions the
/// content selects the format. "-" reads standard input; files named in its scene are relative to
/// the current folder. Throws Error.
[[nodiscard]] MICROTRACE_EXPORT LoadedScene load_scene(const std::filesystem::path& path,
                                                       const LoadOptions& options = {});

/// The same from memory. Error messages name the file `name`; files named in the scene are relative
/// to `folder`. Throws Error.
[[nodiscard]] MICROTRACE_EXPORT LoadedScene parse_scene(std::string_view bytes,
                                                        const std::string& name,
                                                        const std::filesystem::path& folder,
                                                        const LoadOptions& options = {});

/// A scene file that is read and checked once and can be posed at many times. The geometry of a
/// JSON scene's meshes is loaded again for each time.
class MICROTRACE_EXPORT SceneFile {
 public:
  /// Reads like load_scene, but ignores options.time. Throws Error.
  explicit SceneFile(const std::filesystem::path& path, LoadOptions options = {});
  ~SceneFile();
  SceneFile(SceneFile&& other) noexcept;
  SceneFile& operator=(SceneFile&& other) noexcept;

  [[nodiscard]] SceneFormat format() const;

  /// The scene at a time, equal to the result of load_scene. Throws Error.
  [[nodiscard]] LoadedScene at(std::optional<double> time);

 private:
  struct MICROTRACE_HIDDEN Content;
  std::unique_ptr<Content> content_;
};

struct LoadedRadianceMap {
  std::shared_ptr<const RadianceMap> map;
  std::vector<Diagnostic> warnings;
};

/// Reads a latitude-longitude map by OpenEXR (.exr) or OpenImageIO, loading the module. Integer
/// samples (8 and 16 bits) are decoded as sRGB; floating-point samples (.hdr, .exr) are linear;
/// both are assumed to be Rec. 709. Single-channel maps are gray; alpha is ignored. Negative values
/// and NaN become 0, and larger values become kMaxRadiance, with a warning. Throws Error: io if the
/// file can't be read or decoded, limit for a side above 65536 or more than 2^27 pixels,
/// unsupported without the module. `memory`, if given, counts the map during its lifetime and must
/// outlive it.
[[nodiscard]] MICROTRACE_EXPORT LoadedRadianceMap
load_radiance_map(const std::filesystem::path& path, MemoryBudget* memory = nullptr);

enum class PpmEncoding { binary, ascii };  ///< P6 or P3

/// A text file to be written beside a picture.
struct Sidecar {
  std::filesystem::path path;
  std::string text;
};

/// Writes a picture. The extension selects the format: .ppm by the library itself, .png by libpng,
/// .exr by OpenEXR, others by OpenImageIO; modules are loaded when needed. Float formats (.exr,
/// .hdr) store the film's values; others store 8 bits according to its display settings. Colors are
/// premultiplied in float formats and unassociated in others. Only .exr stores further channels,
/// and the position of a crop in the whole picture. The file appears whole or not at all. "-"
/// writes PPM to standard output. A sidecar is completely written before either file replaces its
/// target. Throws Error (usage) if the format can't store the film's contents.
MICROTRACE_EXPORT void save_image(const Film& film, const std::filesystem::path& path,
                                  PpmEncoding ppm = PpmEncoding::binary,
                                  const Sidecar* sidecar = nullptr);

/// The contents of a film besides colors.
struct FilmContents {
  bool alpha = false;
  bool channels = false;
};

/// Throws the Error that save_image would throw immediately for this path and such a film, without
/// writing. Call it before a long rendering.
MICROTRACE_EXPORT void check_image_path(const std::filesystem::path& path,
                                        const FilmContents& contents = {});

/// The same for the path of a sidecar beside its picture.
MICROTRACE_EXPORT void check_sidecar_path(const std::filesystem::path& path,
                                          const std::filesystem::path& picture);

/// Removes the temporary files of pictures being saved. Safe in a signal handler that then ends the
/// process.
MICROTRACE_EXPORT void remove_unfinished_files() noexcept;

/// The bytes of a PPM file. Throws Error (usage) for a film with alpha.
[[nodiscard]] MICROTRACE_EXPORT std::string encode_ppm(const Film& film,
                                                       PpmEncoding ppm = PpmEncoding::binary);

}  // namespace microtrace
