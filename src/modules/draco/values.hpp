#pragma once
#include "io/gltf/mesh/draco_abi.hpp"

#include <draco/attributes/point_attribute.h>

/// Writes the values of all points in the format of `wanted`. Restores quantized values itself, by
/// + - * / and sqrt in float32, because Draco's library may be compiled with fused multiply-adds.
/// Returns null, or an error message.
[[nodiscard]] const char* write_draco_values(const draco::PointAttribute& source,
                                             std::size_t points,
                                             const MicrotraceDracoAttribute& wanted);
