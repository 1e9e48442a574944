#pragma once
#include "accel/kernels/kernel.hpp"

#include <microtrace/primitives.hpp>
#include <microtrace/ray.hpp>

namespace microtrace {

/// True if a ray that hits primitive `id` passes through its open side.
[[nodiscard]] bool meets_open_side(const Primitives& primitives, const OpenSide& open,
                                   const Ray& ray, PrimitiveId id);

}  // namespace microtrace
