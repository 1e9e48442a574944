#pragma once
#include "render/primitive_set.hpp"

#include <microtrace/primitives.hpp>
#include <microtrace/scene.hpp>

#include <cstdint>

namespace microtrace {

/// The triangles of one-sided meshes, whose backs have no coverage in World::base_color.
class HiddenBacks {
 public:
  HiddenBacks(const Scene& scene, const Primitives& primitives);

  /// One bit per primitive, or null if there are none.
  [[nodiscard]] const std::uint32_t* bits() const { return triangles_.bits(); }

 private:
  PrimitiveSet triangles_;
};

}  // namespace microtrace
