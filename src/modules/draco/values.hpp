#pragma once
#include "io/gltf/mesh/draco_abi.hpp"

#include <draco/attributes/point_attribute.h>

/// Writes the values of all points in the attribute's format. Quantized values are restored here,
/// with + - * / and sqrt in float32 without contraction, because the library's code may use fused
/// operations. Returns null, or an error message.
[[nodiscard]] const char* write_draco_values(const draco::PointAttribute& source,
                                             std::size_t points,
                                             const MicrotraceDracoAttribute& wanted);
