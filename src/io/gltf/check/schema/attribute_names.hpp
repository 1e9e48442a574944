#pragma once
/// Names of vertex attributes.

#include <string_view>

namespace microtrace::io::gltf {

/// Returns true for standard names such as JOINTS_0 and TEXCOORD_12, and for application-specific
/// names, which begin with an underscore.
[[nodiscard]] bool is_attribute_name(std::string_view name);

/// Like is_attribute_name, for the attributes of instances (EXT_mesh_gpu_instancing).
[[nodiscard]] bool is_instance_attribute_name(std::string_view name);

}  // namespace microtrace::io::gltf
