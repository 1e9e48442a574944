// A program that uses the installed library: every public header, a scene in memory, and the
// requested pictures.
#include <microtrace/aov.hpp>
#include <microtrace/bvh.hpp>
#include <microtrace/camera.hpp>
#include <microtrace/defaults.hpp>
#include <microtrace/error.hpp>
#include <microtrace/film.hpp>
#include <microtrace/framing.hpp>
#include <microtrace/hit.hpp>
#include <microtrace/integrator.hpp>
#include <microtrace/io.hpp>
#include <microtrace/math.hpp>
#include <microtrace/ray.hpp>
#include <microtrace/render.hpp>
#include <microtrace/scene.hpp>
#include <microtrace/shape.hpp>
#include <microtrace/sidecar.hpp>

#include <cstdio>

int main(int argc, char** argv) {
  try {
    auto [scene, warnings, format] = microtrace::parse_scene(R"({
      "version": 1,
      "cameras": [{"type": "perspective", "position": [0, 0, 5], "direction": [0, 0, -1], "up": [0, 1, 0],
                   "vertical_fov": 60}],
      "objects": [{"type": "sphere", "center": [0, 0, 0], "radius": 1, "color": [1, 0, 0]}]
    })",
                                                             "memory.json", ".");
    const auto settings = microtrace::default_settings(scene, format);
    const auto film = microtrace::render(scene, settings.camera, {9, 9}, settings.options);
    for (int i = 1; i < argc; ++i) microtrace::save_image(film, argv[i]);
    const microtrace::Vec3 middle = film.row(4)[4], corner = film.row(0)[0];
    const bool right =
        warnings.empty() && middle == microtrace::Vec3(1, 0, 0) && corner == microtrace::Vec3(0);
    return right ? 0 : 1;
  } catch (const microtrace::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
