#pragma once
#include <microtrace/primitives.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <type_traits>

namespace microtrace::build {

/// Reads the shapes of primitives, of which most are in the same mesh as the one before.
class ShapeReader {
 public:
  static constexpr std::size_t kAhead = 16;

  explicit ShapeReader(const Primitives& primitives) : primitives_(&primitives) {}

  /// Calls f(shape) with the primitive's shape, as Primitives::visit does.
  template <class F>
  decltype(auto) visit(PrimitiveId id, F&& f) {
    if (!is_in_mesh(id)) {
      const PlacedObject object = primitives_->object_of(id);
      const PlacedMesh& mesh = object.mesh;
      if (!mesh || mesh.placement != nullptr) return primitives_->visit(id, f);
      first_ = object.first_id;
      triangles_ = {mesh.arrays->triangles.data(), mesh.arrays->triangles.size()};
      positions_ = mesh.arrays->positions.data();
    }
    const auto [a, b, c] = triangles_[id - first_];
    return f(Triangle{.a = positions_[a], .b = positions_[b], .c = positions_[c]});
  }

  /// Returns the primitive's shape if it is a triangle.
  [[nodiscard]] std::optional<Triangle> triangle(PrimitiveId id) {
    return visit(id, []<class AnyShape>(const AnyShape& shape) -> std::optional<Triangle> {
      if constexpr (std::is_same_v<AnyShape, Triangle>)
        return shape;
      else
        return std::nullopt;
    });
  }

  /// Prefetches the vertex indices of a triangle. Should be called kAhead primitives before the
  /// triangle is read.
  void prefetch(PrimitiveId id) const {
    if (is_in_mesh(id)) __builtin_prefetch(&triangles_[id - first_]);
  }

 private:
  [[nodiscard]] bool is_in_mesh(PrimitiveId id) const { return id - first_ < triangles_.size(); }

  const Primitives* primitives_;
  // The last mesh that has no placement
  PrimitiveId first_ = 0;
  std::span<const std::array<std::uint32_t, 3>> triangles_;
  const Vec3* positions_ = nullptr;
};

}  // namespace microtrace::build
