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

[[nodiscard]] inline Triangle triangle_of(const PlacedMesh& mesh, std::size_t index) {
  const auto [a, b, c] = mesh.corners(index);
  return {.a = mesh.position(a), .b = mesh.position(b), .c = mesh.position(c)};
}

/// An object of a scene, by reference.
struct PlacedObject {
  std::size_t index;             ///< in Scene::objects
  std::size_t run;               ///< index of the run that contains it
  const Object* first;           ///< the first object of the run
  PlacedMesh mesh;               ///< without arrays if the shape is not a mesh
  PrimitiveId first_id, end_id;  ///< the range of its primitives
};

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
    const std::size_t run = run_index(id);
    return is_run_single_ ? run : object_of(id).index;
  }
  /// The index in Objects::runs() of the run that contains the primitive.
  [[nodiscard]] std::size_t run_index(PrimitiveId id) const {
    const std::uint32_t* const runs = &range_runs_[id >> range_shift_];
    return runs[0] == runs[1] ? runs[0] : find_run(runs[0], runs[1], id);
  }
  /// The object that contains the primitive.
  [[nodiscard]] PlacedObject object_of(PrimitiveId id) const {
    const std::size_t run = run_index(id);
    const ObjectRun own = scene_->objects.run(run);
    if (own.count > 1) return object_in(own, run, id);
    return {.index = own.begin,
            .run = run,
            .first = own.first,
            .mesh = own.mesh(0),
            .first_id = first_ids_[run],
            .end_id = first_ids_[run + 1]};
  }
  /// The lowest PrimitiveId in the object that contains the primitive.
  [[nodiscard]] PrimitiveId first_id(PrimitiveId id) const { return object_of(id).first_id; }
  /// The lowest PrimitiveId in the object with this index.
  [[nodiscard]] PrimitiveId first_id_of(std::size_t object) const;
  /// The lowest PrimitiveId after those in the object with this index.
  [[nodiscard]] PrimitiveId end_id_of(std::size_t object) const {
    return object < scene_->objects.size() - 1 ? first_id_of(object + 1) : count_;
  }
  /// The lowest PrimitiveId in the run with this index.
  [[nodiscard]] PrimitiveId first_id_of_run(std::size_t run) const { return first_ids_[run]; }
  [[nodiscard]] const Scene& scene() const { return *scene_; }
  /// See Objects: in scenes with many instances, object_of() needs less memory.
  [[nodiscard]] const Object& object(PrimitiveId id) const {
    return scene_->objects[object_index(id)];
  }

  /// Calls f(shape) with the primitive's shape, which is a Triangle for a primitive of a mesh.
  template <class F>
  decltype(auto) visit(PrimitiveId id, F&& f) const {
    const PlacedObject object = object_of(id);
    return std::visit(
        [&](const auto& shape) -> decltype(auto) {
          if constexpr (is_mesh<decltype(shape)>)
            return f(triangle_of(object.mesh, id - object.first_id));
          else
            return f(shape);
        },
        object.first->shape);
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
    for (const ObjectRun& run : scene_->objects.runs())
      for (std::size_t i = 0; i < run.count; ++i) for_each_of(run, i, f);
  }
  /// Does the same for the primitives of the object with index run.begin + i.
  template <class F>
  void for_each_of(const ObjectRun& run, std::size_t i, F&& f) const {
    PrimitiveId id = first_id_of(run.begin + i);
    std::visit(
        [&](const auto& shape) {
          if constexpr (is_mesh<decltype(shape)>) {
            const PlacedMesh mesh = run.mesh(i);
            for (std::size_t k = 0; k < shape.triangles.size(); ++k) f(id++, triangle_of(mesh, k));
          } else {
            f(id, shape);
          }
        },
        run.first->shape);
  }

 private:
  template <class T>
  static constexpr bool is_mesh = std::is_same_v<std::remove_cvref_t<T>, Mesh>;

  void make_ranges();
  /// Searches the runs from `first` to `last`.
  [[nodiscard]] std::size_t find_run(std::uint32_t first, std::uint32_t last, PrimitiveId id) const;
  /// Returns the object of a run that contains the primitive.
  [[nodiscard]] PlacedObject object_in(const ObjectRun& own, std::size_t run, PrimitiveId id) const;

  const Scene* scene_;
  std::vector<PrimitiveId> first_ids_;  // the lowest PrimitiveId of each run, and count_
  PrimitiveId count_ = 0;
  bool is_run_single_;  // whether each run is a single object
  // Element i is the run of primitive i << range_shift_. The last element is the last run.
  std::vector<std::uint32_t> range_runs_;
  unsigned range_shift_ = 0;
};

}  // namespace microtrace
