#pragma once
/// OpenGL's numbers for the types of an accessor's components (glTF 2.0, section 5.1.3).

namespace microtrace::io::gltf {

inline constexpr int i8 = 5120, u8 = 5121, i16 = 5122, u16 = 5123, u32 = 5125, f32 = 5126;

}  // namespace microtrace::io::gltf
