#pragma once
/// Maps a PrimitiveId to its shape.

#include <microtrace/export.hpp>
#include <microtrace/hit.hpp>
#include <microtrace/scene.hpp>

#include <cstddef>
#include <optional>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace microtrace {

[[nodiscard]] inline Triangle triangle_of(const Mesh& mesh, std::size_t index) {
  const auto [a, b, c] = mesh.corners(index);
  return {.a = mesh.position(a), .b = mesh.position(b), .c = mesh.position(c)};
}

/// Gives access to all primitives of a scene by number. The scene must outlive this object and must
/// not change.
class MICROTRACE_EXPORT Primitives {
 public:
  /// Throws Error (limit) if the scene has 2^32 primitives or more.
  explicit Primitives(const Scene& scene);
  explicit Primitives(const Scene&&) = delete;  // would dangle

  /// The number of primitives; PrimitiveIds run from 0 to count() - 1.
  [[nodiscard]] PrimitiveId count() const { return count_; }

  /// The index in Scene::objects of the object that contains the primitive.
  [[nodiscard]] std::size_t object_index(PrimitiveId id) const {
    const std::uint32_t* const objects = &range_objects_[id >> range_shift_];
    return objects[0] == objects[1] ? objects[0] : find_object(objects[0], objects[1], id);
  }
  /// The lowest PrimitiveId in the object that contains the primitive.
  [[nodiscard]] PrimitiveId first_id(PrimitiveId id) const { return first_ids_[object_index(id)]; }
  /// The lowest PrimitiveId in the object with this index.
  [[nodiscard]] PrimitiveId first_id_of(std::size_t object) const { return first_ids_[object]; }
  /// The lowest PrimitiveId after those in the object with this index.
  [[nodiscard]] PrimitiveId end_id_of(std::size_t object) const { return first_ids_[object + 1]; }
  [[nodiscard]] const Scene& scene() const { return *scene_; }
  [[nodiscard]] const Object& object(PrimitiveId id) const {
    return scene_->objects[object_index(id)];
  }

  /// Calls f(shape) with the primitive's shape, which is a Triangle for a primitive of a mesh.
  template <class F>
  decltype(auto) visit(PrimitiveId id, F&& f) const {
    const std::size_t k = object_index(id);
    return std::visit(
        [&](const auto& shape) -> decltype(auto) {
          if constexpr (is_mesh<decltype(shape)>)
            return f(triangle_of(shape, id - first_ids_[k]));
          else
            return f(shape);
        },
        scene_->objects[k].shape);
  }

  /// Returns the primitive's shape if it is a triangle, either a separate one or one of a mesh.
  [[nodiscard]] std::optional<Triangle> triangle(PrimitiveId id) const {
    return visit(id, []<class AnyShape>(const AnyShape& shape) -> std::optional<Triangle> {
      if constexpr (std::is_same_v<AnyShape, Triangle>)
        return shape;
      else
        return std::nullopt;
    });
  }

  /// Calls f(id, shape) for every primitive in the order of PrimitiveIds.
  template <class F>
  void for_each(F&& f) const {
    for (std::size_t k = 0; k < scene_->objects.size(); ++k) for_each_of(k, f);
  }
  /// Does the same for the primitives of the object with this index.
  template <class F>
  void for_each_of(std::size_t object, F&& f) const {
    std::visit(
        [&](const auto& shape) {
          PrimitiveId id = first_ids_[object];
          if constexpr (is_mesh<decltype(shape)>) {
            for (std::size_t i = 0; i < shape.triangles.size(); ++i) f(id++, triangle_of(shape, i));
          } else {
            f(id, shape);
          }
        },
        scene_->objects[object].shape);
  }

 private:
  template <class T>
  static constexpr bool is_mesh = std::is_same_v<std::remove_cvref_t<T>, Mesh>;

  void make_ranges();
  /// Searches the objects from `first` to `last`.
  [[nodiscard]] std::size_t find_object(std::uint32_t first, std::uint32_t last,
                                        PrimitiveId id) const;

  const Scene* scene_;
  std::vector<PrimitiveId> first_ids_;  // the lowest PrimitiveId of each object, and count_
  PrimitiveId count_ = 0;
  // Element i is the object of primitive i << range_shift_. The last element is the last object.
  std::vector<std::uint32_t> range_objects_;
  unsigned range_shift_ = 0;
};

}  // namespace microtrace
