#include "scene/surface/surface_finder.hpp"

#include "scene/kernels/dispatch.hpp"

#include <microtrace/surface_interaction.hpp>

#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <memory>
#include <variant>

namespace microtrace {
namespace {

bool has_uv(const Mesh& mesh) {
  return !mesh.uv_sets.empty() && !mesh.uv_sets[0].empty();
}

MeshArrays arrays_of(const Mesh& mesh) {
  if (mesh.triangles.empty()) return {};
  return {.positions = mesh.positions.data(),
          .corners = mesh.triangles.data()->data(),
          .normals = mesh.normals.empty() ? nullptr : mesh.normals.data(),
          .uv = has_uv(mesh) ? mesh.uv_sets[0].data() : nullptr};
}

constexpr std::array<std::uint32_t, 3> kCorners{0, 1, 2};

/// Stands for a placed mesh.
constexpr std::uint32_t kPlaced = std::numeric_limits<std::uint32_t>::max();

MeshArrays arrays_of(const Triangle& triangle) {
  static_assert(sizeof(Triangle) == 3 * sizeof(Vec3));
  return {.positions = &triangle.a, .corners = kCorners.data()};
}

MeshArrays arrays_of(const auto&) {
  return {};
}

/// A triangle of a placed mesh, with transformed vertices.
struct PlacedTriangle {
  Triangle triangle;
  Vec3 normals[3];
  Vec2 uv[3];
  MeshArrays arrays;

  void set(const PlacedMesh& mesh, PrimitiveId primitive) {
    const auto corners = mesh.corners(primitive);
    const bool has_normals = !mesh.arrays->normals.empty(), has_set = has_uv(*mesh.arrays);
    triangle = triangle_of(mesh, primitive);
    for (std::size_t k = 0; k < 3; ++k) {
      if (has_normals) normals[k] = mesh.normal(corners[k]);
      if (has_set) uv[k] = mesh.arrays->uv_sets[0][corners[k]];
    }
    arrays = arrays_of(triangle);
    arrays.normals = has_normals ? normals : nullptr;
    arrays.uv = has_set ? uv : nullptr;
  }
};

void set(SurfaceBatch& batch, std::size_t i, const SurfaceInteraction& at) {
  for (glm::length_t axis = 0; axis < 3; ++axis) {
    batch.p[axis][i] = at.p[axis];
    batch.n[axis][i] = static_cast<float>(at.n[axis]);
    batch.ns[axis][i] = static_cast<float>(at.ns[axis]);
    batch.barycentrics[axis][i] =
        at.triangle ? static_cast<float>(at.triangle->barycentrics[axis]) : 0;
  }
  batch.side[i] = at.front ? 1 : -1;
  const DVec2 uv = at.uv(0).value_or(DVec2(0));
  batch.uv[0][i] = static_cast<float>(uv.x);
  batch.uv[1][i] = static_cast<float>(uv.y);
}

}  // namespace

SurfaceFinder::SurfaceFinder(const Primitives& primitives) : primitives_(primitives) {
  const Objects& objects = primitives.scene().objects;
  const auto is_placed = [&](std::size_t run) {
    return objects.run(run).mesh(0).placement != nullptr;
  };
  std::size_t count = objects.runs().size();
  while (count > 0 && is_placed(count - 1)) --count;
  mesh_of_run_.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    if (is_placed(i)) {
      mesh_of_run_.push_back(kPlaced);
      continue;
    }
    const MeshArrays arrays =
        std::visit([](const auto& shape) { return arrays_of(shape); }, objects.run(i).first->shape);
    const bool has_triangles = arrays.positions != nullptr;
    mesh_of_run_.push_back(has_triangles ? static_cast<std::uint32_t>(meshes_.size()) : 0);
    if (has_triangles) meshes_.push_back(arrays);
  }
}

template <class Visit>
void SurfaceFinder::for_each(const Primitives& primitives, Hits hits, const Visit& visit) {
  PlacedObject object{};
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (!hits[i]) continue;
    const PrimitiveId id = hits[i]->id;
    // Most hits are on the same object as the previous hit.
    if (id < object.first_id || id >= object.end_id) object = primitives.object_of(id);
    visit(i, object, id - object.first_id);
  }
}

void SurfaceFinder::find_ids(Hits hits, SurfaceBatch& batch) const {
  for_each(primitives_, hits,
           [&](std::size_t i, const PlacedObject& object, PrimitiveId primitive) {
             batch.object[i] = static_cast<std::uint32_t>(object.index);
             batch.primitive[i] = primitive;
           });
}

void SurfaceFinder::find(std::span<const Ray> rays, Hits hits, const SurfaceParts& parts,
                         SurfaceBatch& batch, const SceneKernels& kernels) const {
  std::uint64_t others = 0;
  batch.triangles = 0;
  std::unique_ptr<std::array<PlacedTriangle, kSurfaceLanes>> placed;  // made if there are any
  for_each(primitives_, hits,
           [&](std::size_t i, const PlacedObject& object, PrimitiveId primitive) {
             batch.object[i] = static_cast<std::uint32_t>(object.index);
             batch.primitive[i] = primitive;
             const std::uint32_t mesh =
                 object.run < mesh_of_run_.size() ? mesh_of_run_[object.run] : kPlaced;
             if (mesh == kPlaced) {
               if (!placed) placed = std::make_unique<std::array<PlacedTriangle, kSurfaceLanes>>();
               (*placed)[i].set(object.mesh, primitive);
               batch.mesh[i] = &(*placed)[i].arrays;
               batch.corners[i] = kCorners.data();
             } else {
               batch.mesh[i] = &meshes_[mesh];
               batch.corners[i] = meshes_[mesh].corners + std::size_t{3} * primitive;
             }
             (mesh != 0 ? batch.triangles : others) |= std::uint64_t{1} << i;
           });
  if (batch.triangles != 0)
    others |= batch.triangles & ~kernels.find_surfaces(rays.data(), parts, batch);
  for (; others != 0; others &= others - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(others));
    set(batch, i, interact(primitives_, rays[i], *hits[i]));
  }
}

void SurfaceFinder::find(std::span<const Ray> rays, Hits hits, const SurfaceParts& parts,
                         SurfaceBatch& batch) const {
  static const SceneKernels& best = kSceneKernels.best();
  find(rays, hits, parts, batch, best);
}

}  // namespace microtrace
