#pragma once
#include "render/shading/primitive_set.hpp"

#include <microtrace/primitives.hpp>
#include <microtrace/scene.hpp>

namespace microtrace {

/// The triangles of one-sided meshes, whose backs have no coverage in World::base_color.
class OneSidedTriangles : public PrimitiveSet {
 public:
  OneSidedTriangles(const Scene& scene, const Primitives& primitives);
};

}  // namespace microtrace
