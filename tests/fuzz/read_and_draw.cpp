#include "read_and_draw.hpp"

#include <microtrace/io.hpp>
#include <microtrace/path.hpp>
#include <microtrace/primitives.hpp>
#include <microtrace/render.hpp>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <optional>
#include <unistd.h>

namespace microtrace::fuzz {
namespace {

void expect(bool promise, const char* words) {
  if (promise) return;
  std::cerr << "broken promise: " << words << '\n';
  std::abort();
}

// The folder stays empty, so files that a scene names don't exist.
const std::filesystem::path& empty_folder() {
  static const std::filesystem::path folder = [] {
    std::string pattern =
        (std::filesystem::temp_directory_path() / "microtrace-fuzz-XXXXXX").string();
    expect(mkdtemp(pattern.data()) != nullptr, "a temporary folder can be made");
    static const std::string made = pattern;
    std::atexit([] { rmdir(made.c_str()); });
    return std::filesystem::path(pattern);
  }();
  return folder;
}

std::optional<LoadedScene> read(std::string_view bytes, const std::string& name) {
  // Poses assets whose files have an odd number of bytes, and renders others as stored.
  LoadOptions options;
  if (bytes.size() % 2 == 1) options = {.time = 0.5, .animation = "all"};
  try {
    return parse_scene(bytes, name, empty_folder(), options);
  } catch (const Error& error) {
    expect(error.kind() != ErrorKind::internal, "no failure inside");
    expect(!error.diagnostic().message.empty() && !error.diagnostic().text().empty(),
           "every error has a message");
    return std::nullopt;
  }
}

void check(const Scene& scene) {
  for (const Object& object : scene.objects) {
    const auto* mesh = std::get_if<Mesh>(&object.shape);
    if (mesh == nullptr) continue;
    for (const auto& triangle : mesh->triangles) {
      for (const std::uint32_t corner : triangle)
        expect(corner < mesh->positions.size(), "a triangle's corners are positions of its mesh");
    }
  }
}

std::optional<Film> draw(const Scene& scene, const RenderOptions& options) {
  try {
    return render(scene, scene.cameras[0].camera, {.width = 4, .height = 3}, options);
  } catch (const Error& error) {
    expect(error.kind() == ErrorKind::usage || error.kind() == ErrorKind::limit,
           "accepted scenes can be rendered");
    return std::nullopt;
  }
}

/// Path traces the scene. If the scene has no environment, uses the studio or only the scene's own
/// lights.
void draw_lit(Scene& scene, bool studio) {
  const PathIntegrator path({.max_depth = 8});
  if (!scene.environment && studio) scene.environment = Environment{.content = Studio{}};
  const std::optional<Film> film = draw(scene, {.threads = 1, .integrator = &path, .samples = 2});
  for (std::uint32_t y = 0; film && y < film->size().height; ++y) {
    for (const Vec3& pixel : film->row(y)) {
      expect(std::isfinite(pixel.x) && std::isfinite(pixel.y) && std::isfinite(pixel.z),
             "light is finite");
    }
  }
}

}  // namespace

void read_and_draw(std::string_view bytes, const std::string& name) {
  std::optional<LoadedScene> loaded = read(bytes, name);
  if (!loaded) return;
  for (const Diagnostic& warning : loaded->warnings)
    expect(!warning.message.empty(), "every warning has a message");
  Scene& scene = loaded->scene;
  check(scene);
  constexpr PrimitiveId kFew = 1000;
  if (scene.cameras.empty() || Primitives(scene).count() > kFew) return;
  static_cast<void>(draw(scene, {.threads = 1}));
  draw_lit(scene, bytes.size() % 4 < 2);
}

}  // namespace microtrace::fuzz
