// Uses the installed library: includes all public headers, makes a scene in memory, renders the
// requested pictures, and defines an integrator that casts shadow rays.
#include <microtrace/microtrace.hpp>

#include <cstdio>
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
    return right ? 0 : 1;
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
