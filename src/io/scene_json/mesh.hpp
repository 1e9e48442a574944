#pragma once
/// The objects of a JSON scene that come from a glTF file of their own.

#include "io/json/reader.hpp"

#include <microtrace/io.hpp>
#include <microtrace/math.hpp>

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

namespace microtrace::io {

/// The glTF files of a scene's meshes. One that several meshes show is read and checked once.
class MeshFiles {
 public:
  /// Files are sought in `folder`. Both must outlive this.
  MeshFiles(const std::filesystem::path& folder, const LoadOptions& options);
  ~MeshFiles();

  /// Says that read() will be asked for this member of "objects".
  void expect(const JsonReader& json);

  /// Reads a member of "objects" of type mesh and the file that it names, posed as the options say:
  /// its objects with their own names and colours, and its warnings. Throws Error, of kind io and
  /// at the member "file" if that file can't be read.
  [[nodiscard]] LoadedScene read(const JsonReader& json);

 private:
  struct File;

  [[nodiscard]] std::unique_ptr<File> open(const JsonReader& file,
                                           const std::filesystem::path& path) const;

  const std::filesystem::path& folder_;
  const LoadOptions& options_;
  std::map<std::string, std::size_t> uses_;  // that are still to come, by the member "file"
  std::map<std::string, std::unique_ptr<File>> files_;  // that were used and will be again
};

/// Reads a member "transform": translation * rotation * scale, or a column-major affine matrix.
[[nodiscard]] DMat4 read_transform(const JsonReader& json);

}  // namespace microtrace::io
