#pragma once
#include <microtrace/scene.hpp>

#include <cstdint>

namespace microtrace {

/// Size in bytes of a mesh's arrays after its segments are widened (segments.hpp).
[[nodiscard]] std::uint64_t memory_of(const Mesh& mesh);

/// Whether placed meshes share their arrays with others, or are transformed copies.
enum class PlacedMeshes { shared, copied };

/// Size in bytes of a scene's objects with their arrays, except for arrays of placed meshes that
/// are shared.
[[nodiscard]] std::uint64_t memory_of(const Scene& scene,
                                      PlacedMeshes placed = PlacedMeshes::shared);

/// Size in bytes of a copy whose segments are widened. It shares the arrays of other meshes.
[[nodiscard]] std::uint64_t memory_to_widen(const Scene& scene);

}  // namespace microtrace
