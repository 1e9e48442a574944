#include "support/cases/adversarial_scenes.hpp"

#include <microtrace/primitives.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace microtrace::adversarial {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Returns a point, a segment whose third vertex is at one end or between them, or a triangle. Half
// of the calls use a small grid, on which many vertices coincide.
Corners degenerate_corners(Random& random) {
  const bool on_grid = random.one_in(2);
  const auto anywhere = [&] { return on_grid ? random.on_grid(2) : random.in_cube(2); };
  Corners corners;
  const Vec3 a = anywhere();
  switch (random.between(0, 3)) {
    case 0:
      return {a, a, a};
    case 1:
      corners = {a, a, anywhere()};
      break;
    case 2: {
      const Vec3 edge = on_grid ? random.on_grid(1) : random.in_cube(0.5F);
      corners = {a, a + edge, a + 2.0F * edge};
      break;
    }
    default:
      return {a, a + random.in_cube(0.5F), a + random.in_cube(0.5F)};
  }
  std::swap(corners[0], corners[static_cast<std::size_t>(random.between(0, 2))]);
  return corners;
}

Mesh random_mesh(Random& random, SceneKind kind) {
  const auto near = [&](const Vec3& c, float size) { return c + random.in_cube(size); };
  switch (kind) {
    case SceneKind::soup:
      return mesh_of(random.between(1, 400), [&] {
        const Vec3 c = random.in_cube(1);
        return Corners{near(c, 0.1F), near(c, 0.1F), near(c, 0.1F)};
      });
    case SceneKind::lattice:
      return mesh_of(random.between(1, 400), [&] {
        return Corners{random.on_grid(4), random.on_grid(4), random.on_grid(4)};
      });
    case SceneKind::huge_and_tiny:
      return mesh_of(random.between(1, 300), [&] {
        const Vec3 c = random.in_cube(1);
        const float size = random.power_of_two(-20, 6);
        return Corners{near(c, size), near(c, size), near(c, size)};
      });
    case SceneKind::far_from_zero: {
      const Vec3 c = random.in_cube(0x1p22F);
      return mesh_of(random.between(1, 300), [&] {
        return Corners{near(c, 4), near(c, 4), near(c, 4)};
      });
    }
    case SceneKind::slivers:
      return mesh_of(random.between(1, 300), [&] {
        const Vec3 a = random.in_cube(1), b = random.in_cube(1);
        return Corners{a, b, near((a + b) * 0.5F, random.power_of_two(-26, -6))};
      });
    case SceneKind::walls:
      return mesh_of(random.between(1, 300), [&] {
        const int axis = random.between(0, 2);
        Corners corners{random.on_grid(3), random.on_grid(3), random.on_grid(3)};
        corners[1][axis] = corners[2][axis] = corners[0][axis];
        return corners;
      });
    case SceneKind::degenerate:
      return mesh_of(random.between(1, 300), [&] { return degenerate_corners(random); });
    case SceneKind::any_size:
      break;
  }
  return mesh_of(random.between(1, 100), [&] {
    const float size = random.power_of_two(-140, 60);
    Corners corners{random.in_cube(size), random.in_cube(size), random.in_cube(size)};
    if (random.one_in(10)) corners[0].x = random.one_in(2) ? NAN : kInfinity;
    return corners;
  });
}

SceneKind any_kind(Random& random) {
  return kSceneKinds[static_cast<std::size_t>(
      random.between(0, static_cast<int>(kSceneKinds.size()) - 1))];
}

// Returns a vertex of a random triangle, or a point of an edge or of the interior.
Vec3 target(Random& random, const Scene& scene) {
  const Object& object = scene.objects[static_cast<std::size_t>(
      random.between(0, static_cast<int>(scene.objects.size()) - 1))];
  const auto* mesh = std::get_if<Mesh>(&object.shape);
  if (mesh == nullptr) return random.on_grid(4);
  const int last = static_cast<int>(mesh->triangles.size()) - 1;
  const Triangle t = triangle_of(*mesh, static_cast<std::size_t>(random.between(0, last)));
  switch (random.between(0, 3)) {
    case 0:
      return t.a;
    case 1:
      return (t.a + t.b) * 0.5F;
    case 2: {
      const float s = float(random.unit());
      return t.b + (t.c - t.b) * s;
    }
    default: {
      const float u = float(random.unit()), v = float(random.unit()) * (1 - u);
      return t.a + (t.b - t.a) * u + (t.c - t.a) * v;
    }
  }
}

}  // namespace

const char* name(SceneKind kind) {
  switch (kind) {
    case SceneKind::soup:
      return "soup";
    case SceneKind::lattice:
      return "lattice";
    case SceneKind::huge_and_tiny:
      return "huge_and_tiny";
    case SceneKind::far_from_zero:
      return "far_from_zero";
    case SceneKind::slivers:
      return "slivers";
    case SceneKind::walls:
      return "walls";
    case SceneKind::degenerate:
      return "degenerate";
    case SceneKind::any_size:
      return "any_size";
  }
  return "";
}

Scene random_scene(Random& random) {
  return random_scene(random, any_kind(random));
}

Scene random_scene(Random& random, SceneKind kind) {
  Scene scene;
  const auto add = [&](Shape shape) {
    scene.objects.push_back({.name = "", .shape = std::move(shape)});
  };
  add(random_mesh(random, kind));
  if (random.one_in(2)) add(random_mesh(random, any_kind(random)));
  if (random.one_in(4)) add(scene.objects[0].shape);  // the copy makes every hit a tie
  for (int i = random.between(-20, 20); i > 0; --i) {
    add(Sphere{random.on_grid(4), float(random.between(0, 2))});
    add(Disc{random.on_grid(4), random.on_grid(2), float(random.between(0, 2))});
  }
  if (random.one_in(4)) add(Plane{random.on_grid(4), random.on_grid(2)});
  return scene;
}

Vec3 origin(Random& random, const Scene& scene) {
  switch (random.between(0, 4)) {
    case 0:
      return target(random, scene);
    case 1:
      return random.on_grid(8);
    case 2:
      return target(random, scene) + random.in_cube(3);
    case 3:
      return random.in_cube(100);
    default:
      return random.in_cube(2);
  }
}

Ray random_ray(Random& random, const Scene& scene, const Vec3& o) {
  Ray ray{.o = o, .d = target(random, scene) - o};
  if (random.one_in(6)) ray.d = random.on_grid(2);
  if (random.one_in(6)) ray.d[random.between(0, 2)] = 0;
  if (random.one_in(8)) ray.d *= random.power_of_two(-30, 30);
  if (random.one_in(16)) ray.d *= random.power_of_two(-140, 120);
  if (random.one_in(20)) ray.d[random.between(0, 2)] = random.any_float(-149, -100);
  if (random.one_in(3)) ray.t_min = 0;
  if (random.one_in(5)) ray.t_max = random.one_in(2) ? 1 : float(random.unit() * 4);
  if (random.one_in(16) && ray.d != Vec3(0)) {
    // The interval ends near the target.
    const float size = std::max({std::abs(ray.d.x), std::abs(ray.d.y), std::abs(ray.d.z)});
    ray.t_max = std::min(1 / size, std::numeric_limits<float>::max()) * float(random.unit() * 4);
  }
  if (random.one_in(20)) ray.t_min = std::min(1.0F, ray.t_max);
  return ray;
}

std::vector<Ray> unrelated_rays(Random& random, const Scene& scene, int count) {
  std::vector<Ray> rays;
  const bool near_each_other = random.one_in(3);
  const Vec3 center = origin(random, scene);
  const float t_max = random.one_in(2) ? kInfinity : float(random.unit() * 2);
  while (static_cast<int>(rays.size()) < count) {
    const Vec3 o = near_each_other ? center + random.in_cube(0.1F) : origin(random, scene);
    Ray ray = random_ray(random, scene, o);
    if (near_each_other) ray.t_max = std::max(ray.t_min, t_max);
    if (random.one_in(60)) ray.d *= 0x1p60F;
    if (random.one_in(60)) ray.d = Vec3(0);
    if (random.one_in(60)) ray.o[random.between(0, 2)] = random.one_in(2) ? NAN : kInfinity;
    if (random.one_in(60)) ray.t_min = -1;
    rays.insert(rays.end(), static_cast<std::size_t>(random.one_in(40) ? 12 : 1), ray);
  }
  return rays;
}

}  // namespace microtrace::adversarial
