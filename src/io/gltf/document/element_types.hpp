#pragma once
/// The types of an accessor's elements and components, and the bytes that they take (glTF 2.0,
/// section 3.6.2.2).

#include <cstddef>
#include <string_view>

namespace microtrace::io::gltf {

enum class ElementType { scalar, vec2, vec3, vec4, mat2, mat3, mat4 };

/// OpenGL's numbers for component types.
inline constexpr int i8 = 5120, u8 = 5121, i16 = 5122, u16 = 5123, u32 = 5125, f32 = 5126;

/// The type with that name in glTF, "VEC3"; the name must be one of the seven.
[[nodiscard]] ElementType element_type(std::string_view name);

[[nodiscard]] constexpr bool is_matrix(ElementType type) {
  return type >= ElementType::mat2;
}
[[nodiscard]] std::size_t component_count(ElementType type);

/// Bytes of one component.
[[nodiscard]] std::size_t component_size(int component_type);
/// Bytes from one element to the next where they lie without gaps: each column of a matrix is
/// padded to a multiple of 4 bytes (glTF 2.0, section 3.6.2.4).
[[nodiscard]] std::size_t element_size(ElementType type, int component_type);
/// Bytes of the last element: without the padding after its last column.
[[nodiscard]] std::size_t element_extent(ElementType type, int component_type);

}  // namespace microtrace::io::gltf
