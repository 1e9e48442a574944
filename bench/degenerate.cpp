// Measures the time to render a mesh together with coincident copies of itself, and together with
// triangles without area, relative to the time to render the mesh alone.

#include "arguments.hpp"
#include "rays.hpp"
#include "support/cases/generated_meshes.hpp"
#include "timing.hpp"

#include <microtrace/framing.hpp>
#include <microtrace/path.hpp>
#include <microtrace/render.hpp>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace microtrace;
using namespace microtrace::bench;

constexpr ImageSize kSize{.width = 320, .height = 240};
constexpr std::uint32_t kSamples = 4;  // samples per pixel of path-traced pictures

/// Returns a pseudorandom point at the distance `half_width` from the origin, which is the mesh's
/// center.
Vec3 place(std::uint64_t counter, double half_width) {
  return {half_width * random_point(1, counter)};
}

Mesh copies(const Mesh& mesh, int count, bool turned) {
  Mesh all = mesh;
  for (int copy = 1; copy < count; ++copy) {
    for (auto triangle : mesh.triangles) {
      if (turned) std::rotate(triangle.begin(), triangle.begin() + copy % 3, triangle.end());
      if (turned && copy % 2 == 1) std::swap(triangle[0], triangle[1]);
      all.triangles.push_back(triangle);
    }
  }
  return all;
}

/// Adds segments around the mesh. Segments of length 0 are points.
Mesh with_segments(Mesh mesh, std::uint64_t count, double length) {
  for (std::uint64_t i = 0; i < count; ++i) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const Vec3 p = place(2 * i, 1.2), q = p + place(2 * i + 1, length);
    for (const Vec3& end : {p, q}) mesh.positions.push_back(end);
    mesh.triangles.push_back({first, first + 1, first});
  }
  return mesh;
}

struct Subject {
  const char* name;
  Mesh mesh;
};

std::vector<Subject> subjects() {
  const Mesh sphere = generated::displaced_sphere(20000), none;
  std::vector<Subject> all{{"mesh", sphere}};
  all.push_back({"2 copies", copies(sphere, 2, false)});
  all.push_back({"16 copies", copies(sphere, 16, false)});
  all.push_back({"16 copies, turned", copies(sphere, 16, true)});
  all.push_back({"1 point", with_segments(sphere, 1, 0)});
  all.push_back({"100 points", with_segments(sphere, 100, 0)});
  all.push_back({"10000 points", with_segments(sphere, 10000, 0)});
  all.push_back({"100 points alone", with_segments(none, 100, 0)});
  all.push_back({"10000 short segments", with_segments(sphere, 10000, 0.02)});
  all.push_back({"10000 long segments", with_segments(sphere, 10000, 1)});
  all.push_back({"10000 long ones alone", with_segments(none, 10000, 1)});
  return all;
}

class Pictures {
 public:
  explicit Pictures(const Mesh& mesh) {
    scene_.environment = Environment{};
    set(mesh);
    camera_ = default_camera(scene_, kSize);
  }

  void set(const Mesh& mesh) {
    scene_.objects.clear();
    scene_.objects.push_back({.name = "mesh", .shape = mesh});
  }

  /// Returns the time of the fastest run.
  [[nodiscard]] double seconds(bool lit, unsigned runs) const {
    const PathIntegrator path;
    RenderOptions options{.threads = 1};
    if (lit) options.integrator = &path, options.samples = kSamples;
    double least = std::numeric_limits<double>::infinity();
    for (unsigned i = 0; i < runs; ++i) {
      least = std::min(least, bench::seconds(1, [&] {
                         static_cast<void>(render(scene_, camera_, kSize, options));
                       }));
    }
    return least;
  }

 private:
  Scene scene_;
  Camera camera_;
};

void run(unsigned runs) {
  const std::vector<Subject> all = subjects();
  Pictures pictures(all[0].mesh);
  std::printf("%-24s %9s %7s %9s %7s %9s\n", "", "triangles", "flat", "ratio", "lit", "ratio");
  double flat_alone = 0, lit_alone = 0;
  for (const auto& [name, mesh] : all) {
    pictures.set(mesh);
    const double flat = pictures.seconds(false, runs), lit = pictures.seconds(true, runs);
    if (flat_alone == 0) flat_alone = flat, lit_alone = lit;
    std::printf("%-24s %9zu %7.3f %9.2f %7.3f %9.2f\n", name, mesh.triangles.size(), flat,
                flat / flat_alone, lit, lit / lit_alone);
    std::fflush(stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc > 2) throw std::invalid_argument("usage: bench_degenerate [RUNS]");
    run(argc == 2 ? number(argv[1]) : 3);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
