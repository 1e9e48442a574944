#pragma once
/// Names of vertex attributes.

#include <string_view>

namespace microtrace::io::gltf {

/// True for standard names like JOINTS_0 and TEXCOORD_12, and for application-specific ones, which
/// begin with an underscore.
[[nodiscard]] bool is_attribute_name(std::string_view name);

/// The same for instance attributes (EXT_mesh_gpu_instancing).
[[nodiscard]] bool is_instance_attribute_name(std::string_view name);

}  // namespace microtrace::io::gltf
