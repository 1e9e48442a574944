#pragma once
/// Reads glTF 2.0 (Khronos, ISO/IEC 12113:2022), text or binary. docs/gltf.md lists the supported
/// features, the warnings and the limits.

#include <microtrace/io.hpp>
#include <microtrace/math.hpp>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace microtrace::io {

/// An asset that is read and checked once, and can then be posed for many different times.
class GltfFile {
 public:
  /// Reads the bytes of a .gltf or .glb file. The first four bytes distinguish the two. The bytes
  /// must outlive this object. Error messages name the file `name`. External files are loaded from
  /// `folder` or below. Throws Error: invalid_scene, unsupported (a required extension, another
  /// version), io (an external file), limit, usage (an unknown animation).
  GltfFile(std::string_view bytes, const std::string& name, const std::filesystem::path& folder,
           const LoadOptions& options = {});
  ~GltfFile();
  GltfFile(GltfFile&& other) noexcept;
  GltfFile& operator=(GltfFile&& other) noexcept;

  [[nodiscard]] SceneChoices choices() const;

  /// Returns the scene at a time (see LoadOptions). Transforms are composed in float64. Each vertex
  /// is rounded to float32 once, relative to Scene::origin. Throws Error.
  [[nodiscard]] LoadedScene at(std::optional<double> time);

  /// Returns the scene as a part of another scene that has its own origin. The affine transform
  /// `world_from_asset` is applied last. `copies` is the number of such parts, which may share
  /// meshes.
  [[nodiscard]] LoadedScene placed(std::optional<double> time, const DMat4& world_from_asset,
                                   std::size_t copies = 1);

 private:
  struct Content;
  std::unique_ptr<Content> content_;
};

}  // namespace microtrace::io
