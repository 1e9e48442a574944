#include "cli/statistics.hpp"

#include <cstdio>
#include <sys/resource.h>

namespace microtrace::cli {
namespace {

double peak_memory_mib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

}  // namespace

double Stopwatch::lap() {
  const Clock::time_point now = Clock::now();
  const double seconds = std::chrono::duration<double>(now - last_).count();
  last_ = now;
  return seconds;
}

void Stopwatch::report(Statistics kind, const Scene& scene, ImageSize size,
                       const RenderCounts& counts, unsigned threads) const {
  if (kind == Statistics::none) return;
  std::size_t primitives = 0;
  for (const Object& object : scene.objects) primitives += primitive_count(object.shape);
  const auto rays = static_cast<double>(counts.samples);
  const char* format =
      kind == Statistics::json
          ? R"({"objects": %zu, "primitives": %zu, "width": %u, "height": %u, "threads": %u, )"
            R"("load_s": %.6f, "read_s": %.6f, "validate_s": %.6f, "bake_s": %.6f, )"
            R"("build_s": %.6f, "trace_s": %.6f, "render_s": %.6f, "write_s": %.6f, )"
            R"("samples_per_pixel": %u, "rays": %.0f, )"
            R"("rays_per_s": %.0f, "peak_memory_mib": %.1f})"
            "\n"
          : "objects      %zu\nprimitives   %zu\npicture      %u x %u\nthreads      %u\n"
            "load         %.6f s\n  read       %.6f s\n  validate   %.6f s\n  bake       %.6f s\n"
            "build tree   %.6f s\ntrace        %.6f s\nrender       %.6f s\n"
            "write        %.6f s\nsamples      %u a pixel\nrays         %.0f\n"
            "rays/s       %.0f\npeak memory  %.1f MiB\n";
  std::fprintf(stderr, format, scene.objects.size(), primitives, size.width, size.height, threads,
               load_, load_times_.read, load_times_.validate, load_times_.bake, times_.build,
               times_.trace, render_, write_, counts.samples_per_pixel, rays, rays / render_,
               peak_memory_mib());
}

}  // namespace microtrace::cli
