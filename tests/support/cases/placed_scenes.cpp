#include "support/cases/placed_scenes.hpp"

#include "support/cases/adversarial_scenes.hpp"
#include "support/cases/generated_meshes.hpp"

#include <memory>

#include <glm/gtc/matrix_transform.hpp>

namespace microtrace::adversarial {
namespace {

DMat4 rotation(Random& random) {
  const DVec3 axis = DVec3(random.in_cube(1)) + DVec3(0, 0, 2);
  return glm::rotate(DMat4(1), 6.3 * random.unit(), axis);
}

DMat4 scaling(Random& random, int lo, int hi) {
  const double x = random.power_of_two(lo, hi), y = random.power_of_two(lo, hi);
  const double z = random.power_of_two(lo, hi);
  return glm::scale(DMat4(1), DVec3(x, y, random.one_in(4) ? -z : z));
}

DMat4 translation(Random& random, float distance) {
  return glm::translate(DMat4(1), DVec3(random.in_cube(distance)));
}

}  // namespace

const char* name(PlacementKind kind) {
  constexpr std::array kNames = {"rigid",    "lattice", "similar", "affine",
                                 "far_away", "extreme", "nested"};
  return kNames[static_cast<std::size_t>(kind)];
}

DMat4 placement(Random& random, PlacementKind kind) {
  switch (kind) {
    case PlacementKind::rigid: {
      const DMat4 moved = translation(random, 4) * rotation(random);
      return random.one_in(3) ? moved * scaling(random, 0, 0) : moved;
    }
    case PlacementKind::lattice: {
      DMat4 m = glm::translate(DMat4(1), DVec3(random.on_grid(2)));
      if (random.one_in(3)) m = m * scaling(random, -1, 1);
      if (random.one_in(4)) m = m * DMat4(DMat4(0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1));
      return m;
    }
    case PlacementKind::similar: {
      const double size = random.power_of_two(-40, 40);
      return translation(random, 4) * glm::scale(rotation(random), DVec3(size));
    }
    case PlacementKind::affine: {
      DMat4 m = translation(random, 4) * rotation(random) * scaling(random, -3, 3);
      m[1] += m[0] * double{random.symmetric()};
      m[2] += m[1] * double{random.symmetric()};
      return m;
    }
    case PlacementKind::far_away:
      return translation(random, 0x1p20F) * rotation(random);
    case PlacementKind::extreme: {
      DMat4 m = translation(random, 4) * rotation(random) * scaling(random, -40, 40);
      if (random.one_in(3)) m[random.between(0, 2)] = DVec4(0);
      return m;
    }
    case PlacementKind::nested:
      break;
  }
  DMat4 m(1);
  for (int i = random.between(2, 4); i > 0; --i)
    m = m * placement(random, random.one_in(3) ? PlacementKind::affine : PlacementKind::rigid);
  return m;
}

Mesh shared_mesh(Random& random) {
  Mesh mesh;
  if (random.one_in(8)) {
    mesh = generated::displaced_sphere(3000);
  } else {
    mesh = std::get<Mesh>(random_scene(random).objects.front().shape);
  }
  return mesh;
}

/// Returns an array of some of the first elements, which are not copied.
template <class T>
Array<T> beginning_of(const Array<T>& array, Random& random) {
  if (array.empty()) return {};
  const auto owner = std::make_shared<const Array<T>>(array);
  const int size = random.between(1, static_cast<int>(array.size()));
  return Array<T>::borrow({owner->data(), static_cast<std::size_t>(size)}, owner);
}

PlacedScenes random_placed_scenes(Random& random, PlacementKind kind) {
  PlacedScenes scenes;
  for (int meshes = random.between(1, 2); meshes > 0; --meshes) {
    const Mesh mesh = shared_mesh(random);
    DMat4 last(1);
    if (random.one_in(3)) {
      std::vector<Placement> placements;
      for (int i = random.between(1, 6); i > 0; --i)
        placements.emplace_back(placement(random, kind));
      scenes.add_run(mesh, placements);
      continue;
    }
    for (int i = random.between(1, 6); i > 0; --i) {
      Mesh placed = mesh;
      if (random.one_in(4)) placed.triangles = beginning_of(mesh.triangles, random);
      if (!random.one_in(8)) last = placement(random, kind);  // otherwise at the same place
      placed.placement = std::make_shared<const Placement>(last);
      scenes.add(placed);
      if (random.one_in(6)) scenes.add(mesh);
    }
  }
  if (random.one_in(3)) scenes.add(Sphere{random.on_grid(3), 1});
  if (random.one_in(3)) scenes.add(Plane{random.on_grid(3), Vec3(0, 1, 0)});
  return scenes;
}

}  // namespace microtrace::adversarial
