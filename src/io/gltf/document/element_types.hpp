#pragma once
/// Types and sizes of accessor elements and components (glTF 2.0, section 3.6.2.2).

#include <cstddef>
#include <string_view>

namespace microtrace::io::gltf {

enum class ElementType { scalar, vec2, vec3, vec4, mat2, mat3, mat4 };

/// Component types, with the values of the corresponding OpenGL constants.
inline constexpr int kInt8 = 5120, kUint8 = 5121, kInt16 = 5122, kUint16 = 5123, kUint32 = 5125,
                     kFloat32 = 5126;

/// Returns the type that has this name in glTF, such as "VEC3". The name must be one of the seven
/// that glTF defines.
[[nodiscard]] ElementType element_type(std::string_view name);

[[nodiscard]] constexpr bool is_matrix(ElementType type) {
  return type >= ElementType::mat2;
}
[[nodiscard]] std::size_t component_count(ElementType type);

/// Returns the size of a component in bytes.
[[nodiscard]] std::size_t component_size(int component_type);
/// Returns the number of bytes between the starts of tightly packed elements. Each column of a
/// matrix is padded to a multiple of 4 bytes (glTF 2.0, section 3.6.2.4).
[[nodiscard]] std::size_t element_size(ElementType type, int component_type);
/// Returns the size of the last element in bytes. Its last column needs no padding.
[[nodiscard]] std::size_t element_extent(ElementType type, int component_type);

}  // namespace microtrace::io::gltf
