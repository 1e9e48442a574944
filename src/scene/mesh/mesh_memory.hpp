#pragma once
#include <microtrace/scene.hpp>

#include <cstdint>

namespace microtrace {

/// Bytes of a mesh's arrays once its segments are widened (segments.hpp).
[[nodiscard]] std::uint64_t memory_of(const Mesh& mesh);

/// Bytes of the objects that a scene owns; copies do not share them.
[[nodiscard]] std::uint64_t memory_of(const Scene& scene);

}  // namespace microtrace
