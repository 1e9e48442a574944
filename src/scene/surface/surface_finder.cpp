#include "scene/surface/surface_finder.hpp"

#include "scene/kernels/dispatch.hpp"

#include <microtrace/surface_interaction.hpp>

#include <array>
#include <bit>
#include <memory>
#include <variant>

namespace microtrace {
namespace {

MeshArrays arrays_of(const Mesh& mesh) {
  if (mesh.triangles.empty()) return {};
  const bool has_uv = !mesh.uv_sets.empty() && !mesh.uv_sets[0].empty();
  return {.positions = mesh.positions.data(),
          .corners = mesh.triangles.data()->data(),
          .normals = mesh.normals.empty() ? nullptr : mesh.normals.data(),
          .uv = has_uv ? mesh.uv_sets[0].data() : nullptr};
}

constexpr std::array<std::uint32_t, 3> kCorners{0, 1, 2};

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

  void set(const Mesh& mesh, const MeshArrays& from, PrimitiveId primitive) {
    const auto corners = mesh.corners(primitive);
    triangle = triangle_of(mesh, primitive);
    for (std::size_t k = 0; k < 3; ++k) {
      if (from.normals != nullptr) normals[k] = mesh.normal(corners[k]);
      if (from.uv != nullptr) uv[k] = from.uv[corners[k]];
    }
    arrays = arrays_of(triangle);
    arrays.normals = from.normals == nullptr ? nullptr : normals;
    arrays.uv = from.uv == nullptr ? nullptr : uv;
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
  const std::vector<Object>& objects = primitives.scene().objects;
  entries_.reserve(objects.size());
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const auto* mesh = std::get_if<Mesh>(&objects[i].shape);
    entries_.push_back(
        {.mesh = std::visit([](const auto& shape) { return arrays_of(shape); }, objects[i].shape),
         .placed = mesh != nullptr && mesh->placement ? mesh : nullptr,
         .first_id = primitives.first_id_of(i),
         .count = static_cast<PrimitiveId>(primitive_count(objects[i].shape))});
  }
}

template <class Visit>
void SurfaceFinder::for_each(Hits hits, const Visit& visit) const {
  const Entry* entry = nullptr;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (!hits[i]) continue;
    const PrimitiveId id = hits[i]->id;
    // Most hits are on the same object as the previous hit.
    if (entry == nullptr || id - entry->first_id >= entry->count)
      entry = &entries_[primitives_.object_index(id)];
    visit(i, *entry, id);
  }
}

void SurfaceFinder::find_ids(Hits hits, SurfaceBatch& batch) const {
  for_each(hits, [&](std::size_t i, const Entry& entry, PrimitiveId id) {
    batch.object[i] = static_cast<std::uint32_t>(&entry - entries_.data());
    batch.primitive[i] = id - entry.first_id;
  });
}

void SurfaceFinder::find(std::span<const Ray> rays, Hits hits, const SurfaceParts& parts,
                         SurfaceBatch& batch, const SceneKernels& kernels) const {
  std::uint64_t others = 0;
  batch.triangles = 0;
  std::unique_ptr<std::array<PlacedTriangle, kSurfaceLanes>> placed;  // made if there are any
  for_each(hits, [&](std::size_t i, const Entry& entry, PrimitiveId id) {
    batch.object[i] = static_cast<std::uint32_t>(&entry - entries_.data());
    batch.primitive[i] = id - entry.first_id;
    batch.mesh[i] = &entry.mesh;
    if (entry.placed != nullptr) {
      if (!placed) placed = std::make_unique<std::array<PlacedTriangle, kSurfaceLanes>>();
      (*placed)[i].set(*entry.placed, entry.mesh, batch.primitive[i]);
      batch.mesh[i] = &(*placed)[i].arrays;
      batch.corners[i] = kCorners.data();
    } else if (entry.mesh.corners != nullptr) {
      batch.corners[i] = entry.mesh.corners + std::size_t{3} * batch.primitive[i];
    }
    (entry.mesh.positions != nullptr ? batch.triangles : others) |= std::uint64_t{1} << i;
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
