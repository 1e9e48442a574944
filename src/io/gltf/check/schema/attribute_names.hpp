#pragma once
/// Names of attributes.

#include <string_view>

namespace microtrace::io::gltf {

/// JOINTS_0, TEXCOORD_12 and their like, and whatever an application calls _ITS_OWN.
[[nodiscard]] bool is_attribute_name(std::string_view name);

/// The same by EXT_mesh_gpu_instancing.
[[nodiscard]] bool is_instance_attribute_name(std::string_view name);

}  // namespace microtrace::io::gltf
