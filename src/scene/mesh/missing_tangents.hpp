#pragma once
/// Generates tangents for scenes that their caller made.

#include <microtrace/scene.hpp>

#include <memory>

namespace microtrace {

/// Returns the scene if each mesh has tangents whose material needs them, else a copy in which they
/// are generated as for glTF assets (see make_tangents). The copy has the same primitives, and
/// shares all other arrays. Leaves out meshes without the texture coordinates that define tangents,
/// and those with numbers that are not finite. Charges the memory to memory_account().
[[nodiscard]] std::shared_ptr<const Scene> with_tangents(std::shared_ptr<const Scene> scene);

}  // namespace microtrace
