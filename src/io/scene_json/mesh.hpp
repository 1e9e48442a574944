#pragma once
/// Reads objects of a JSON scene from glTF files.

#include "io/json/reader.hpp"

#include <microtrace/io.hpp>
#include <microtrace/math.hpp>

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

namespace microtrace::io {

/// The glTF files of a scene's meshes. If several meshes use a file, it is read and checked once.
class MeshFiles {
 public:
  /// Paths are relative to `folder`. Both arguments must outlive this object.
  MeshFiles(const std::filesystem::path& folder, const LoadOptions& options);
  ~MeshFiles();

  /// Announces that read() will be called for this item of "objects".
  void expect(const JsonReader& json);

  /// Reads an item of "objects" with type mesh, and its file, posed according to the options. The
  /// result has the file's objects with their own names and colors, and its warnings. Throws Error.
  /// If the file can't be read, the error has kind io and points to the member "file".
  [[nodiscard]] LoadedScene read(const JsonReader& json);

 private:
  struct File;

  [[nodiscard]] std::unique_ptr<File> open(const JsonReader& file,
                                           const std::filesystem::path& path) const;

  const std::filesystem::path& folder_;
  const LoadOptions& options_;
  std::map<std::string, std::size_t> uses_;  // number of remaining uses, by the member "file"
  std::map<std::string, std::unique_ptr<File>> files_;  // files with remaining uses
};

/// Reads a member "transform", which is translation * rotation * scale or a column-major affine
/// matrix.
[[nodiscard]] DMat4 read_transform(const JsonReader& json);

}  // namespace microtrace::io
