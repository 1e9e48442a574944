#pragma once
/// Builds small glTF assets in memory, and loads them for tests.

#include "support/json.hpp"

#include <microtrace/io.hpp>
#include <microtrace/math.hpp>

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace microtrace::tests {

enum ComponentType {
  kInt8 = 5120,
  kUint8 = 5121,
  kInt16 = 5122,
  kUint16 = 5123,
  kUint32 = 5125,
  kFloat32 = 5126
};

constexpr int component_type_of(std::int8_t) {
  return kInt8;
}
constexpr int component_type_of(std::uint8_t) {
  return kUint8;
}
constexpr int component_type_of(std::int16_t) {
  return kInt16;
}
constexpr int component_type_of(std::uint16_t) {
  return kUint16;
}
constexpr int component_type_of(std::uint32_t) {
  return kUint32;
}
constexpr int component_type_of(float) {
  return kFloat32;
}

/// Returns the bytes of a list of numbers.
template <typename Number>
std::string bytes_of(const std::vector<Number>& numbers) {
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number)};
}

/// Builds the JSON of an asset, and its only buffer.
struct AssetBuilder {
  Json json = {{"asset", {{"version", "2.0"}}}};
  std::string buffer;

  /// Appends an item to an array of the root object. Returns the item's index.
  std::size_t add(const char* array, Json item);
  /// Appends bytes to the buffer at a multiple of 4. Adds a view of these bytes and returns its
  /// index.
  std::size_t add_view(std::string_view bytes, std::size_t stride = 0);
  std::size_t add_positions(const std::vector<Vec3>& positions);
  std::size_t add_indices(const std::vector<std::uint32_t>& indices, ComponentType type);
  /// Adds an accessor for numbers, which get a view of their own. Scalars get min and max. `shape`
  /// is glTF's type: "SCALAR", "VEC3", "MAT4".
  template <typename Number>
  std::size_t add_numbers(const char* shape, const std::vector<Number>& numbers,
                          bool normalized = false) {
    return add_accessor(shape, bytes_of(numbers), component_type_of(Number{}), normalized);
  }
  std::size_t add_accessor(const char* shape, const std::string& bytes, int component_type,
                           bool normalized);
  /// Adds a sampler, and a channel for it, to animation `index`, which is created if necessary.
  void animate(std::size_t index, std::size_t node, const char* path, std::size_t input,
               std::size_t output, const char* interpolation = "LINEAR");
  /// Adds a mesh with one primitive, on a new node of the default scene. Returns the node's index.
  std::size_t add_object(Json primitive);

  /// The asset as JSON with its buffer in a data URI, and as a GLB file.
  [[nodiscard]] std::string embedded() const;
  [[nodiscard]] std::string glb() const;
  [[nodiscard]] Json with_buffer(const char* uri) const;
};

struct GlbChunk {
  std::uint32_t type;
  std::string data;
};
inline constexpr std::uint32_t kJsonChunk = 0x4E4F534A, kBinChunk = 0x004E4942;

/// Returns a GLB file of exactly these chunks.
[[nodiscard]] std::string glb_file(const std::vector<GlbChunk>& chunks, std::uint32_t version = 2);
[[nodiscard]] std::string padded(std::string bytes, char filler);
[[nodiscard]] std::string base64(std::string_view bytes);

/// Returns the cube [-1, 1]^3 on a node named "Cube": 8 vertices, 12 triangles with u16 indices,
/// and a red material.
[[nodiscard]] AssetBuilder cube();

/// Returns the text of the asset after one change: sets the value at the JSON pointer `where`, or
/// removes it if `value` is empty. If `where` is empty, applies `value` as a JSON merge patch (RFC
/// 7396) to the whole asset.
[[nodiscard]] std::string mutated(const AssetBuilder& asset, const char* where, const char* value);

/// Loads one asset at options.time.
[[nodiscard]] LoadedScene load_gltf(std::string_view bytes, const std::string& name,
                                    const std::filesystem::path& folder,
                                    const DMat4& world_from_asset = DMat4(1),
                                    const LoadOptions& options = {});
/// Loads bytes as the file "test.gltf", for which no folder is given.
[[nodiscard]] LoadedScene load(const std::string& bytes);
[[nodiscard]] LoadedScene load(const AssetBuilder& asset);
[[nodiscard]] LoadedScene load(const AssetBuilder& asset, const LoadOptions& options);

/// Returns the base color factor of an object's material.
[[nodiscard]] Vec4 color_of(const LoadedScene& loaded, std::size_t object);

/// Returns the corner positions of an object's triangles, in order.
[[nodiscard]] std::vector<std::array<Vec3, 3>> triangles_of(const Object& object);

/// Formats warnings as "/pointer: message".
[[nodiscard]] std::vector<std::string> texts(const std::vector<Diagnostic>& warnings);

}  // namespace microtrace::tests
