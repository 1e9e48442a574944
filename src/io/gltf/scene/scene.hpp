#pragma once
/// glTF 2.0 (Khronos, ISO/IEC 12113:2022), text and binary, into a Scene. docs/gltf.md lists what
/// is honoured, what is warned about, and the limits.

#include <microtrace/io.hpp>
#include <microtrace/math.hpp>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace microtrace::io {

/// One asset, read and checked, to be posed at any number of times.
class GltfFile {
 public:
  /// Reads the bytes of a .gltf or .glb file, told apart by their first four; they must outlive it.
  /// `name` stands in messages; external buffers are sought in `folder` and nowhere above it.
  /// Throws Error: invalid_scene, unsupported (a required extension, another version), io (a
  /// buffer's file), limit, usage (an animation that is not there).
  GltfFile(std::string_view bytes, const std::string& name, const std::filesystem::path& folder,
           const LoadOptions& options = {});
  ~GltfFile();
  GltfFile(GltfFile&& other) noexcept;
  GltfFile& operator=(GltfFile&& other) noexcept;

  /// The scene at a time, as LoadOptions says. Node transforms are composed in float64 and each
  /// vertex is rounded once to float32, next to Scene::origin. Throws Error.
  [[nodiscard]] LoadedScene at(std::optional<double> time);

  /// The same as part of another scene, whose origin is its own: `world_from_asset` (affine) comes
  /// first.
  [[nodiscard]] LoadedScene placed(std::optional<double> time, const DMat4& world_from_asset);

 private:
  struct Content;
  std::unique_ptr<Content> content_;
};

/// Reads one asset and poses it at options.time, as GltfFile::placed does.
[[nodiscard]] LoadedScene load_gltf(std::string_view bytes, const std::string& name,
                                    const std::filesystem::path& folder,
                                    const DMat4& world_from_asset = DMat4(1),
                                    const LoadOptions& options = {});

}  // namespace microtrace::io
