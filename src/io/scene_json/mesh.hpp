#pragma once
/// Objects of a JSON scene that are read from glTF files.

#include "io/json/reader.hpp"

#include <microtrace/io.hpp>
#include <microtrace/math.hpp>

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

namespace microtrace::io {

/// The glTF files of a scene's meshes. A file used by several meshes is read and checked once.
class MeshFiles {
 public:
  /// Paths are relative to `folder`. Both must outlive this object.
  MeshFiles(const std::filesystem::path& folder, const LoadOptions& options);
  ~MeshFiles();

  /// Announces that read() will be called for this member of "objects".
  void expect(const JsonReader& json);

  /// Reads a member of "objects" of type mesh and its file, posed according to the options: its
  /// objects with their own names and colors, and its warnings. Throws Error, with kind io and at
  /// the member "file" if the file can't be read.
  [[nodiscard]] LoadedScene read(const JsonReader& json);

 private:
  struct File;

  [[nodiscard]] std::unique_ptr<File> open(const JsonReader& file,
                                           const std::filesystem::path& path) const;

  const std::filesystem::path& folder_;
  const LoadOptions& options_;
  std::map<std::string, std::size_t> uses_;             // remaining uses, by the member "file"
  std::map<std::string, std::unique_ptr<File>> files_;  // files with remaining uses
};

/// Reads a member "transform": translation * rotation * scale, or a column-major affine matrix.
[[nodiscard]] DMat4 read_transform(const JsonReader& json);

}  // namespace microtrace::io
