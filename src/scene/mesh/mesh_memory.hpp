#pragma once
#include <microtrace/scene.hpp>

#include <cstdint>

namespace microtrace {

/// Size in bytes of a mesh's arrays after its segments are widened (segments.hpp).
[[nodiscard]] std::uint64_t memory_of(const Mesh& mesh);

/// Whether placed meshes share their arrays with others, or are transformed copies.
enum class PlacedMeshes { shared, copied };

/// Size in bytes of the objects that a scene owns. Copies of a scene don't share these objects.
[[nodiscard]] std::uint64_t memory_of(const Scene& scene,
                                      PlacedMeshes placed = PlacedMeshes::shared);

}  // namespace microtrace
