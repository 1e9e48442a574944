#pragma once
/// Builds small glTF assets that are compressed by meshoptimizer.

#include "gltf/asset_builder.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace microtrace::tests {

/// An extension, and the version of its attributes.
struct MeshoptFormat {
  const char* extension;
  int version;
};
inline constexpr MeshoptFormat kExtMeshopt = {"EXT_meshopt_compression", 0};
inline constexpr MeshoptFormat kKhrMeshopt = {"KHR_meshopt_compression", 1};

[[nodiscard]] std::string encoded_attributes(const std::string& bytes, std::size_t stride,
                                             int version);
[[nodiscard]] std::string encoded_triangles(const std::vector<unsigned>& indices);
[[nodiscard]] std::string encoded_indices(const std::vector<unsigned>& indices);

/// An asset whose views are compressed in buffer 0. Buffer 1 stands for the uncompressed data and
/// has no bytes.
struct MeshoptAsset {
  const char* extension;
  AssetBuilder asset{};
  std::size_t uncompressed = 0;  // size of buffer 1 in bytes

  explicit MeshoptAsset(const char* with_extension);
  std::size_t add_view(const std::string& bytes, const char* mode, std::size_t count,
                       std::size_t stride, const char* filter = nullptr);
  std::size_t add_accessor(std::size_t view, int type, const char* shape, std::size_t count,
                           bool normalized = false);
  [[nodiscard]] Json json() const;
};

}  // namespace microtrace::tests
