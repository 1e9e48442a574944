#pragma once
/// glTF 2.0 (Khronos, ISO/IEC 12113:2022), text and binary, into a Scene. docs/gltf.md lists what
/// is honoured, what is warned about, and the limits.

#include <microtrace/io.hpp>
#include <microtrace/math.hpp>

#include <filesystem>
#include <string>
#include <string_view>

namespace microtrace::io {

/// Reads one asset: the bytes of a .gltf or .glb file, told apart by their first four. `name`
/// stands in messages; external buffers are sought in `folder` and nowhere above it. Node
/// transforms are composed in float64, `world_from_asset` (affine) first, and each vertex is
/// rounded once to float32. Throws Error: invalid_scene, unsupported (a required extension, another
/// version), io (a buffer's file), limit.
[[nodiscard]] LoadedScene load_gltf(std::string_view bytes, const std::string& name,
                                    const std::filesystem::path& folder,
                                    const DMat4& world_from_asset = DMat4(1));

}  // namespace microtrace::io
