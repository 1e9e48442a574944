#pragma once
#include <microtrace/primitives.hpp>
#include <microtrace/scene.hpp>

#include <cstdint>
#include <vector>

namespace microtrace {

/// The triangles of one-sided meshes, whose backs have no coverage in World::base_color.
class HiddenBacks {
 public:
  HiddenBacks(const Scene& scene, const Primitives& primitives);

  /// One bit per primitive, or null if there are none.
  [[nodiscard]] const std::uint32_t* bits() const { return bits_.empty() ? nullptr : bits_.data(); }

 private:
  std::vector<std::uint32_t> bits_;
};

}  // namespace microtrace
