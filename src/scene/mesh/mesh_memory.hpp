#pragma once
#include <microtrace/scene.hpp>

#include <cstdint>

namespace microtrace {

/// Size in bytes of a mesh's arrays after its segments are widened (segments.hpp).
[[nodiscard]] std::uint64_t memory_of(const Mesh& mesh);

/// Size in bytes of the objects that a scene owns. Copies of a scene don't share these objects.
[[nodiscard]] std::uint64_t memory_of(const Scene& scene);

}  // namespace microtrace
