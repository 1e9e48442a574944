#pragma once
/// Data sets: many views of one scene, with one record for each finished view.

#include <microtrace/camera.hpp>
#include <microtrace/export.hpp>
#include <microtrace/film.hpp>
#include <microtrace/framing.hpp>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace microtrace {

/// One view of a data set. Values that are absent are those of the whole data set.
struct DatasetView {
  std::string name{};  ///< for file names; not necessarily unique
  /// The name or the index of a camera of the scene (empty: its default camera), a camera in world
  /// space, or a direction from which the whole scene is framed.
  std::variant<std::string, Camera, View> camera{};
  std::optional<ImageSize> size{};
  std::optional<double> time{};                   ///< seconds into the animation of a glTF asset
  std::optional<std::string> variant{};           ///< see LoadOptions::variant
  std::optional<std::string> environment{};       ///< a value of the option --env
  std::optional<double> environment_rotation{};   ///< degrees
  std::optional<double> environment_intensity{};  ///< a factor
};

/// Reads a list of views, a JSON or .npz file; docs/datasets.md defines both formats. `image` is
/// the size of the calibration images of a .npz file that contains none. Throws Error: io if the
/// file can't be read, invalid_scene if it violates the format.
[[nodiscard]] MICROTRACE_EXPORT std::vector<DatasetView> read_views(
    const std::filesystem::path& path, const std::optional<ImageSize>& image = std::nullopt);

/// Returns `count` views around the scene at this elevation in degrees, equally spaced in azimuth
/// and starting at azimuth 0.
[[nodiscard]] MICROTRACE_EXPORT std::vector<DatasetView> orbit_views(std::uint32_t count,
                                                                     double elevation);

/// Returns `count` views from directions that are spread evenly over the upper hemisphere, from the
/// zenith to the horizon: the points of a Fibonacci lattice (R. Swinbank and R. Purser, Fibonacci
/// grids: a novel approach to global modelling, 2006).
[[nodiscard]] MICROTRACE_EXPORT std::vector<DatasetView> hemisphere_views(std::uint32_t count);

/// Returns `count` views from random directions that are uniformly distributed over the sphere.
/// View i depends only on `seed` and i.
[[nodiscard]] MICROTRACE_EXPORT std::vector<DatasetView> random_views(std::uint32_t count,
                                                                      std::uint32_t seed);

/// What a data set is made of. Its folder refuses views of any other data set.
struct DatasetIdentity {
  std::string program{};                 ///< name and version
  std::string scene{};                   ///< name of the scene file
  std::uint64_t digest = 0;              ///< of all files that were read
  std::string options{};                 ///< all options on which the files depend
  std::uint32_t views = 0;               ///< number of views
  std::string folder{};                  ///< the folder in which the program was started
  std::vector<std::string> arguments{};  ///< with which it was started
};

/// A file of a data set.
struct DatasetFile {
  std::string name;          ///< relative to the data set's folder, separated by /
  std::uint64_t size = 0;    ///< bytes
  std::uint64_t digest = 0;  ///< of its bytes

  bool operator==(const DatasetFile&) const = default;
};

/// The folder of a data set. It contains `dataset.json` with the identity, and
/// `records/NNNNNN.json` for each finished view. Several processes may add views at the same time.
class MICROTRACE_EXPORT DatasetFolder {
 public:
  /// Creates the folder, or continues with an existing one. Throws Error: usage if the folder
  /// contains a different data set, or other files but no data set; io.
  DatasetFolder(std::filesystem::path path, const DatasetIdentity& identity);
  /// Opens an existing data set. Throws Error (io) if there is none, or if dataset.json can't be
  /// read or is damaged.
  explicit DatasetFolder(std::filesystem::path path);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] const DatasetIdentity& identity() const { return identity_; }

  /// Returns the files of a finished view; nothing if the view is not finished or its record is
  /// damaged. Throws Error (io).
  [[nodiscard]] std::optional<std::vector<DatasetFile>> files(std::uint32_t view) const;

  /// True if the view is finished and its files are whole.
  [[nodiscard]] bool is_whole(std::uint32_t view) const;

  /// Records that a view is finished: its files, by their names, are complete. Throws Error (io).
  void finish(std::uint32_t view, const std::vector<std::string>& names);

  /// Returns the number of views that are not finished. Views with damaged records count as
  /// finished.
  [[nodiscard]] std::uint32_t missing() const;

  /// Returns the views whose records are missing or damaged, and those with a file of another size
  /// or, if `is_read(name)` is true, of other bytes. Reads all records and these files. Throws
  /// Error (io).
  [[nodiscard]] std::vector<std::uint32_t> damaged(
      const std::function<bool(const std::string& name)>& is_read) const;

  /// Checks that `manifest.json` is undamaged, lists the files of all views, and that the other
  /// files that it lists are whole. Returns the number of these files and the manifest. Throws
  /// Error (io) with the file that is not as it should be.
  [[nodiscard]] std::uint64_t check_manifest() const;

  /// True if check_manifest() finds nothing wrong.
  [[nodiscard]] bool is_finished() const;

  /// Writes `manifest.json`, the list of all files of finished views and of the files `more`, with
  /// sizes and digests. Throws Error.
  void write_manifest(std::span<const std::string> more) const;

 private:
  [[nodiscard]] MICROTRACE_HIDDEN std::filesystem::path record(std::uint32_t view) const;
  [[nodiscard]] MICROTRACE_HIDDEN std::vector<DatasetFile> recorded(std::uint32_t view) const;

  std::filesystem::path path_;
  DatasetIdentity identity_;
};

/// Writes a file, which appears whole or not at all, and creates its folder. Throws Error (io).
MICROTRACE_EXPORT void write_dataset_file(const std::filesystem::path& path,
                                          std::string_view bytes);

/// Returns the name of the first of these files that is missing in the folder or has other bytes.
/// Throws Error (io).
[[nodiscard]] MICROTRACE_EXPORT std::optional<std::string> first_damaged(
    const std::filesystem::path& folder, std::span<const DatasetFile> files);

/// Fills in a pattern for file names: {scene}, {view}, {view:0Nd} and {name}. Throws Error (usage)
/// for other fields, for names that leave the folder, and if the pattern has no {view} or {name}.
[[nodiscard]] MICROTRACE_EXPORT std::string dataset_file_name(std::string_view pattern,
                                                              std::string_view scene,
                                                              std::uint32_t view,
                                                              std::string_view name);

}  // namespace microtrace
