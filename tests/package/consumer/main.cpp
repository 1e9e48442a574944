// Uses the installed library: includes all public headers, makes a scene in memory, renders the
// requested pictures, defines an integrator that casts shadow rays, and intersects an instance.
#include <microtrace/microtrace.hpp>

#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <vector>

namespace {

using namespace microtrace;

/// Shows normals as colors. Points are black if light from above is blocked.
class LitNormals final : public Integrator {
 public:
  void trace(const World& world, std::span<const Ray> rays, std::span<const SampleId> /*ids*/,
             std::span<Sample> samples) const override {
    std::vector<std::optional<Hit>> hits(rays.size());
    world.bvh.intersect(rays, hits);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      samples[i] = {};
      const auto hit = world.first_visible(rays[i], hits[i]);
      if (!hit) continue;
      const Vec3 up(0, 1, 0);
      const auto origin = world.bvh.spawn_origin(rays[i], *hit, up);
      const bool is_lit = origin && !world.bvh.occluded({.o = *origin, .t_min = 0, .d = up});
      const Vec3 normal(world.surface(rays[i], *hit).ns);
      samples[i] = {.color = is_lit ? normal : Vec3(0), .alpha = 1};
    }
  }
};

/// Returns the color of the central pixel of a picture of 9 x 9 pixels.
Vec3 middle_of(const Film& film) {
  return film.row(4)[4];
}

// Inline functions that the library calls too. Taking their addresses compiles them in this
// program, whose compiler may fuse multiplications and additions.
DMat4 (*volatile const multiply)(const DMat4&, const DMat4&) = &glm::operator*;
Triangle (*volatile const read_triangle)(const PlacedMesh&, std::size_t) = &triangle_of;
DVec3 (Placement::*volatile const place)(const DVec3&) const = &Placement::point;
Vec3 (PlacedMesh::*volatile const read_position)(std::size_t) const = &PlacedMesh::position;

/// Checks that the halves of octahedra fit together if one is an instance and the other a
/// transformed copy, so that the library doesn't use this program's copies of inline functions.
bool do_instances_fit() {
  if (!multiply || !read_triangle || !place || !read_position) return false;
  for (int i = 0; i < 50; ++i) {
    const float size = 1 + static_cast<float>(i) / 49;
    const double turn = std::sqrt(0.5);
    const std::vector<Vec3> positions{{size, size, 0.2F},   {-size, size, 0.2F},
                                      {-size, -size, 0.3F}, {size, -size, 0.3F},
                                      {0.2F, 0.1F, 1.2F},   {0.3F, 0.1F, -1.1F}};
    Mesh upper{.positions = positions, .triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}};
    Mesh lower{.positions = positions, .triangles = {{1, 0, 5}, {2, 1, 5}, {3, 2, 5}, {0, 3, 5}}};
    const DMat4 turned({turn, turn, 0, 0}, {-turn, turn, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1});
    upper.placement = lower.placement = std::make_shared<const Placement>(turned);
    Scene scene;
    scene.objects.push_back({.name = "upper", .shape = upper});
    scene.objects.push_back({.name = "lower", .shape = baked(lower)});
    if (!Solid(PreparedScene(scene)).is_closed()) return false;
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    auto [scene, warnings, format] = parse_scene(R"({
      "version": 1,
      "cameras": [{"type": "perspective", "position": [0, 0, 5], "direction": [0, 0, -1], "up": [0, 1, 0],
                   "vertical_fov": 60}],
      "objects": [{"type": "sphere", "center": [0, 0, 0], "radius": 1, "color": [1, 0, 0]}]
    })",
                                                 "memory.json", ".");
    auto settings = default_settings(scene, format);
    const auto film = render(scene, settings.camera, {9, 9}, settings.options);
    for (int i = 1; i < argc; ++i) save_image(film, argv[i]);
    bool right = warnings.empty() && middle_of(film) == Vec3(1, 0, 0) && film.row(0)[0] == Vec3(0);

    const LitNormals integrator;
    settings.options.integrator = &integrator;
    right = right && middle_of(render(scene, settings.camera, {9, 9}, settings.options)).z > 0.99F;
    scene.objects.push_back({.name = "roof", .shape = Plane{{0, 2, 0}, {0, 1, 0}}});
    right = right && middle_of(render(scene, settings.camera, {9, 9}, settings.options)) == Vec3(0);
    return right && do_instances_fit() ? 0 : 1;
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
