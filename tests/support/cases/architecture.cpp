#include "support/cases/architecture.hpp"

#include "support/cases/generated_meshes.hpp"

#include <cmath>
#include <functional>
#include <stdexcept>
#include <utility>

namespace microtrace::generated {
namespace {

// Returns the output function of SplitMix64, applied to a counter (Steele, Lea, Flood: Fast
// splittable pseudorandom number generators, 2014).
std::uint64_t random_bits(std::uint64_t counter) {
  std::uint64_t z = counter * 0x9E3779B97F4A7C15U;
  z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
  z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
  return z ^ (z >> 31U);
}

/// Adds a quad with counterclockwise vertices of its own. Exporters write flat faces in this way.
void add_quad(Mesh& mesh, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (const Vec3& p : {a, b, c, d}) mesh.positions.push_back(p);
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

/// Adds the six faces of the box lo .. hi. They face inward if `inside` is true.
void add_box(Mesh& mesh, const Vec3& lo, const Vec3& hi, bool inside = false) {
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (const bool upper : {false, true}) {
      Vec3 a = lo;
      a[axis] = upper ? hi[axis] : lo[axis];
      Vec3 b = a, c = a, d = a;
      b[u] = c[u] = hi[u];
      c[v] = d[v] = hi[v];
      if (upper != inside)
        add_quad(mesh, a, b, c, d);
      else
        add_quad(mesh, a, d, c, b);
    }
  }
}

/// Returns a point with coordinates in tenths, a grid to which many modeling programs snap.
Vec3 tenths(int x, int y, int z) {
  return {0.1 * x, 0.1 * y, 0.1 * z};
}
void add_box_of_tenths(Mesh& mesh, const std::array<int, 6>& b, bool inside = false) {
  add_box(mesh, tenths(b[0], b[1], b[2]), tenths(b[3], b[4], b[5]), inside);
}

/// Adds a square area light that faces down. Its edges are 2 * reach long.
void add_lamp(ArchitectureScene& scene, const Vec3& center, float reach) {
  const Vec3 u(reach, 0, 0), v(0, 0, reach);
  add_quad(scene.lamp, center - u - v, center + u - v, center + u + v, center - u + v);
  scene.light = DVec3(center) - DVec3(0, reach / 4, 0);
}

ArchitectureScene room() {
  ArchitectureScene scene{.name = "room",
                          .mesh = {},
                          .lamp = {},
                          .views = {{.position = {0.73, 1.61, 5.37}, .direction = {3, -0.9, -4.1}},
                                    {.position = {4, 1.5, 5.5}, .direction = {0, 0, -1}}}};
  add_box_of_tenths(scene.mesh, {0, 0, 0, 80, 30, 60}, true);
  constexpr std::array<std::array<int, 6>, 14> boxes{{{0, 0, 0, 20, 8, 6},       // along a wall
                                                      {20, 0, 0, 32, 21, 6},     // beside it
                                                      {4, 8, 1, 9, 13, 6},       // on it
                                                      {32, 0, 0, 48, 8, 6},      //
                                                      {33, 8, 0, 47, 17, 1},     // on a wall
                                                      {74, 0, 10, 80, 22, 30},   //
                                                      {74, 22, 10, 80, 30, 30},  // to the ceiling
                                                      {40, 0, 24, 41, 7, 25},    // a table's legs
                                                      {57, 0, 24, 58, 7, 25},    //
                                                      {40, 0, 33, 41, 7, 34},    //
                                                      {57, 0, 33, 58, 7, 34},    //
                                                      {40, 7, 24, 58, 8, 34},    // its top
                                                      {47, 8, 27, 51, 10, 31},   // on the table
                                                      {0, 0, 40, 5, 30, 45}}};   // a pillar
  for (const auto& box : boxes) add_box_of_tenths(scene.mesh, box);
  add_lamp(scene, tenths(40, 29, 30), 0.5F);
  return scene;
}

ArchitectureScene skewed_room() {
  ArchitectureScene scene = room();
  scene.name = "skewed room";
  std::uint64_t counter = 0;
  for (Vec3& p : scene.mesh.positions.edit()) {
    for (int axis = 0; axis < 3; ++axis) {
      const std::uint64_t bits = random_bits(++counter);
      const float by = static_cast<float>(bits % 5) - 2;
      if (bits >> 32U & 1U)
        p[axis] += 0.5e-6F * by;
      else
        p[axis] *= 1 + 0x1p-23F * by;
    }
  }
  return scene;
}

ArchitectureScene voxels() {
  ArchitectureScene scene{
      .name = "voxels",
      .mesh = {},
      .lamp = {},
      .views = {{.position = {21.3, 17.7, 25.1}, .direction = {-1.93, -1.47, -2.51}},
                {.position = {8, 8, 36}, .direction = {0, 0, -1}}}};
  for (std::uint64_t i = 0; i < 16 * 16 * 16; ++i) {
    if (random_bits(i + 1) % 3 != 0) continue;
    const Vec3 lo(i % 16, i / 16 % 16, i / 256);
    add_box(scene.mesh, lo, lo + 1.0F);
  }
  add_lamp(scene, {8, 28, 8}, 4);
  return scene;
}

/// Adds the top or bottom of a plate, which is a square with a square hole in its middle ninth.
void add_holed_plate(Mesh& mesh, int x, int z, int size, int low, int high) {
  const std::array<int, 4> xs{x, x + size, x + 2 * size, x + 3 * size},
      zs{z, z + size, z + 2 * size, z + 3 * size};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (i == 1 && k == 1) continue;
      const auto at = [&](int y, std::size_t a, std::size_t b) { return tenths(xs[a], y, zs[b]); };
      add_quad(mesh, at(high, i, k), at(high, i, k + 1), at(high, i + 1, k + 1),
               at(high, i + 1, k));
      add_quad(mesh, at(low, i, k), at(low, i + 1, k), at(low, i + 1, k + 1), at(low, i, k + 1));
    }
  }
  const auto add_walls = [&](int a, int b, int c, int d, bool inside) {
    const std::array<Vec3, 4> below{tenths(a, low, b), tenths(a, low, d), tenths(c, low, d),
                                    tenths(c, low, b)};
    for (std::size_t i = 0; i < 4; ++i) {
      const Vec3 p = below[i], q = below[(i + 1) % 4], up = tenths(0, high, 0);
      const Vec3 p_up(p.x, up.y, p.z), q_up(q.x, up.y, q.z);
      if (inside)
        add_quad(mesh, q, p, p_up, q_up);
      else
        add_quad(mesh, p, q, q_up, p_up);
    }
  };
  add_walls(xs[0], zs[0], xs[3], zs[3], false);
  add_walls(xs[1], zs[1], xs[2], zs[2], true);
}

ArchitectureScene plates() {
  ArchitectureScene scene{
      .name = "plates",
      .mesh = {},
      .lamp = {},
      .views = {{.position = {8.1, 4.3, 8.9}, .direction = {-1.71, -1.13, -1.97}},
                {.position = {3.3, 9, 3.3}, .direction = {0, -1, 0}, .up = {0, 0, -1}}}};
  add_box_of_tenths(scene.mesh, {-3, -1, -3, 69, 0, 69});
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < 6; ++k) {
      // Stacks stand side by side. The steps of a stack lie on each other.
      const int x = 11 * i, z = 11 * k,
                steps = 1 + static_cast<int>(
                                random_bits(static_cast<std::uint64_t>(36 + 6 * i + k)) % 3);
      add_box_of_tenths(scene.mesh, {x, 0, z, x + 11, 2, z + 11});
      for (int step = 0; step < steps; ++step)
        add_holed_plate(scene.mesh, x + step, z + step, 3 - (step + 1) / 2, 2 + 3 * step,
                        5 + 3 * step);
    }
  }
  add_lamp(scene, {3.3F, 8, 3.3F}, 1.5F);
  return scene;
}

ArchitectureScene stepped_terrain() {
  ArchitectureScene scene{
      .name = "terrain",
      .mesh = terrain(2 * 96 * 96),
      .lamp = {},
      .views = {{.position = {1.13, 0.87, 1.29}, .direction = {-1.07, -0.83, -1.21}},
                {.position = {0, 0.5, 1.5}, .direction = {0, 0, -1}}}};
  for (Vec3& p : scene.mesh.positions.edit()) p.y = std::floor(16 * p.y) / 16;
  add_lamp(scene, {0, 2, 0}, 0.5F);
  return scene;
}

/// Returns a room of n x n x n cells. at(i, k) is the stored coordinate of grid line i as computed
/// for cell k.
ArchitectureScene tiled_room(std::string name, std::uint32_t n,
                             const std::function<float(std::uint32_t, std::uint32_t)>& at) {
  ArchitectureScene scene{.name = std::move(name), .mesh = {}, .lamp = {}, .views = {}};
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (std::uint32_t i = 0; i < n; ++i) {
      for (std::uint32_t k = 0; k < n; ++k) {
        for (const bool upper : {false, true}) {
          Vec3 a(0);
          a[axis] = upper ? at(n, 0) : at(0, 0);
          Vec3 b = a, c = a, d = a;
          a[u] = d[u] = at(i, i);
          b[u] = c[u] = at(i + 1, i);
          a[v] = b[v] = at(k, k);
          c[v] = d[v] = at(k + 1, k);
          if (upper)
            add_quad(scene.mesh, a, d, c, b);
          else
            add_quad(scene.mesh, a, b, c, d);
        }
      }
    }
  }
  const double size = at(n, 0);
  scene.views = {{.position = DVec3(0.13, 0.61, 0.89) * size, .direction = {3, -0.7, -4.1}},
                 {.position = DVec3(0.5, 0.5, 0.875) * size, .direction = {0, 0, -1}}};
  const auto middle = static_cast<float>(size / 2);
  add_lamp(scene, {middle, static_cast<float>(0.875 * size), middle}, middle / 8);
  return scene;
}

}  // namespace

const std::vector<std::string>& architecture_names() {
  static const std::vector<std::string> names{"room",  "voxels",        "plates",     "terrain",
                                              "tiles", "inexact tiles", "skewed room"};
  return names;
}

ArchitectureScene architecture(const std::string& name) {
  if (name == "room") return room();
  if (name == "voxels") return voxels();
  if (name == "plates") return plates();
  if (name == "terrain") return stepped_terrain();
  if (name == "tiles")
    return tiled_room(name, 24,
                      [](std::uint32_t i, std::uint32_t) { return 0.25F * static_cast<float>(i); });
  if (name == "inexact tiles") {
    // Each tile starts at a multiple of 0.1. Its edge length is added in float32.
    return tiled_room(name, 24, [](std::uint32_t i, std::uint32_t k) {
      return 0.1F * static_cast<float>(k) + (i > k ? 0.1F * static_cast<float>(i - k) : 0);
    });
  }
  if (name == "skewed room") return skewed_room();
  throw std::invalid_argument("no scene is named " + name);
}

ArchitectureScene turned(ArchitectureScene scene) {
  scene.name = "turned " + scene.name;
  scene.mesh = turned(std::move(scene.mesh));
  scene.lamp = turned(std::move(scene.lamp));
  scene.light = turned(scene.light);
  for (Pose& view : scene.views)
    view = {.position = turned(view.position),
            .direction = turned(view.direction),
            .up = turned(view.up)};
  return scene;
}

Scene as_scene(const ArchitectureScene& architecture) {
  Scene scene;
  scene.materials = {{.name = "wall", .base_color = {0.7F, 0.7F, 0.7F, 1}},
                     {.name = "lamp", .emissive = Vec3(20)}};
  scene.objects.push_back({.name = "wall", .shape = architecture.mesh, .material = 0});
  scene.objects.push_back({.name = "lamp", .shape = architecture.lamp, .material = 1});
  return scene;
}

}  // namespace microtrace::generated
