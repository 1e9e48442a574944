#pragma once
#include "io/gltf/mesh/draco_abi.hpp"

#include <draco/attributes/point_attribute.h>

/// Writes the values of all points as the attribute asks. What Draco quantised is restored here, by
/// + - * / and sqrt in float32 without contraction, and not by the library, whose machine code may
/// fuse operations where the processor can. Returns null, or what is wrong.
[[nodiscard]] const char* write_draco_values(const draco::PointAttribute& source,
                                             std::size_t points,
                                             const MicrotraceDracoAttribute& wanted);
