#pragma once
/// Files in and out.

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
  /// In file order: oddities, features without effect, and broken rules of the format
  /// (Severity::error) that were repaired or worked around.
  std::vector<Diagnostic> warnings;
  SceneFormat format = SceneFormat::json;
};

/// How much of surfaces is read.
enum class SurfaceDetail {
  shape,  ///< normals and texture coordinates, of images those alone whose alpha decides what is
          ///< seen: for depth, ids and other quantities without color
  color,  ///< what a flat picture shows: base colours, their images and texture coordinates
  all,    ///< normals, tangents, all images and texture coordinates too
  usual,  ///< color in JSON scenes, all in glTF assets: what these are usually drawn with
};

/// Where the time of loading went, in seconds.
struct LoadTimes {
  double read = 0;      ///< the scene file, buffers beside it or in data URIs
  double validate = 0;  ///< from bytes to JSON that is known to be right
  double bake = 0;      ///< vertices, images and all else, placed in the world
};

/// How a scene file is read.
struct LoadOptions {
  SurfaceDetail detail = SurfaceDetail::all;
  /// The variant of a glTF asset's materials (KHR_materials_variants): its name, else its index
  /// from 0; empty: the materials that primitives name themselves.
  std::string variant{};
  /// Seconds since the start of an animation of a glTF asset, clamped to where it is defined;
  /// nothing: the pose that the file gives without any animation.
  std::optional<double> time{};
  /// The animation that `time` is of: its name, else its index from 0; "all": all together, where
  /// none has that name; empty: the first.
  std::string animation{};
  /// Folders beside the scene's own in which a glTF asset's buffers and images may lie, and to
  /// which symbolic links of any scene's files may lead.
  std::vector<std::filesystem::path> allowed_folders{};
  LoadTimes* times = nullptr;  ///< if given, added to
  /// If given, counts what is read and made; must outlive the SceneFile and its scenes. What a
  /// scene takes is counted until its file gives another one or ends.
  MemoryBudget* memory = nullptr;
};

/// Reads a scene file: microtrace JSON (.json) or glTF 2.0 (.gltf, .glb), told apart by content for
/// other endings. "-" is standard input; files that its scene names are sought in the current
/// folder. Throws Error.
[[nodiscard]] MICROTRACE_EXPORT LoadedScene load_scene(const std::filesystem::path& path,
                                                       const LoadOptions& options = {});

/// The same from memory; `name` stands in messages, files named in the scene are sought in
/// `folder`. Throws Error.
[[nodiscard]] MICROTRACE_EXPORT LoadedScene parse_scene(std::string_view bytes,
                                                        const std::string& name,
                                                        const std::filesystem::path& folder,
                                                        const LoadOptions& options = {});

/// A scene file that is read and checked once, to be posed at many times. What a JSON scene's
/// meshes are made of is read anew for each.
class MICROTRACE_EXPORT SceneFile {
 public:
  /// Reads as load_scene does; the options' time plays no part. Throws Error.
  explicit SceneFile(const std::filesystem::path& path, LoadOptions options = {});
  ~SceneFile();
  SceneFile(SceneFile&& other) noexcept;
  SceneFile& operator=(SceneFile&& other) noexcept;

  [[nodiscard]] SceneFormat format() const;

  /// The scene at that time, as load_scene would read it. Throws Error.
  [[nodiscard]] LoadedScene at(std::optional<double> time);

 private:
  struct MICROTRACE_HIDDEN Content;
  std::unique_ptr<Content> content_;
};

struct LoadedRadianceMap {
  std::shared_ptr<const RadianceMap> map;
  std::vector<Diagnostic> warnings;
};

/// Reads a latitude-longitude map by OpenEXR (.exr) or OpenImageIO, whose module is loaded then.
/// Numbers of 8 and 16 bits are taken for sRGB, floating-point ones (.hdr, .exr) for linear; both
/// for Rec. 709. One channel is grey; alpha is left out. Numbers that are negative or none become 0
/// and those above kMaxRadiance that, with a warning. Throws Error: io where the file can't be read
/// or decoded, limit for one with a side above 65536 or more than 2^27 pixels, unsupported without
/// the module.
/// `memory`, if given, counts the map for as long as that lives, and must outlive it.
[[nodiscard]] MICROTRACE_EXPORT LoadedRadianceMap
load_radiance_map(const std::filesystem::path& path, MemoryBudget* memory = nullptr);

enum class PpmEncoding { binary, ascii };  ///< P6 or P3

/// A text to be written beside a picture.
struct Sidecar {
  std::filesystem::path path;
  std::string text;
};

/// Writes a picture; the kind is the ending's: .ppm by the library itself, .png by
/// libpng, .exr by OpenEXR, any other by OpenImageIO, whose modules are loaded then. Float formats
/// (.exr, .hdr) hold the film's numbers, the others 8 bits as its display says. Alpha is multiplied
/// into the colours of float formats and divided out of the others, before they are encoded. Only
/// .exr takes further channels; there a film that is a part of a picture has the whole as its
/// display window. The file appears whole or not at all. "-" is standard output, and takes PPM. A
/// sidecar is written whole before either file takes its place. Throws Error: usage where the
/// format lacks what the film has.
MICROTRACE_EXPORT void save_image(const Film& film, const std::filesystem::path& path,
                                  PpmEncoding ppm = PpmEncoding::binary,
                                  const Sidecar* sidecar = nullptr);

/// What a film has beside colours.
struct FilmContents {
  bool alpha = false;
  bool channels = false;
};

/// Throws the Error that save_image would throw at once for this path and such a film, and writes
/// nothing: to be asked before a long rendering.
MICROTRACE_EXPORT void check_image_path(const std::filesystem::path& path,
                                        const FilmContents& contents = {});

/// The same for a sidecar's path beside that of its picture.
MICROTRACE_EXPORT void check_sidecar_path(const std::filesystem::path& path,
                                          const std::filesystem::path& picture);

/// Removes the temporary files of pictures being saved. Safe in a signal handler that then ends the
/// process.
MICROTRACE_EXPORT void remove_unfinished_files() noexcept;

/// The bytes of a PPM file. Throws Error (usage) for a film with alpha.
[[nodiscard]] MICROTRACE_EXPORT std::string encode_ppm(const Film& film,
                                                       PpmEncoding ppm = PpmEncoding::binary);

}  // namespace microtrace
