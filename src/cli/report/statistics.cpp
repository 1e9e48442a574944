#include "cli/report/statistics.hpp"

#include <array>
#include <cstdint>
#include <cstdio>
#include <sys/resource.h>
#include <utility>

namespace microtrace::cli {
namespace {

double peak_memory_mib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

void print_rays(const RayCounts& counts, bool is_json) {
  const auto number = [](std::uint64_t n) { return static_cast<unsigned long long>(n); };
  const auto print_kind = [&](const char* name, const RayCounts::Kind& kind) {
    if (is_json) {
      std::fprintf(stderr, R"("%s": {"rays": %llu, "s": %.6f}, )", name, number(kind.rays),
                   kind.seconds);
    } else if (kind.rays > 0) {
      std::fprintf(stderr, "  %-10s %llu in %.6f s, %.0f/s\n", name, number(kind.rays),
                   kind.seconds, static_cast<double>(kind.rays) / kind.seconds);
    }
  };
  if (is_json) std::fputs(R"(, "rays_by_kind": {)", stderr);
  print_kind("camera", counts.camera);
  print_kind("path", counts.path);
  print_kind("shadow", counts.shadow);
  if (is_json) {
    std::fprintf(stderr, "\"beyond\": %llu}", number(counts.beyond));
  } else if (counts.beyond > 0) {
    std::fprintf(stderr, "  beyond     %llu\n", number(counts.beyond));
  }
}

void print_stages(const StageCounts& counts, bool is_json) {
  const std::array<std::pair<const char*, std::uint64_t>, 7> rows{
      {{"edges", counts.edges},
       {"filters", counts.filters},
       {"grid", counts.grid},
       {"dyadic", counts.dyadic},
       {"origins", counts.origins},
       {"searched_origins", counts.searched_origins},
       {"missing_origins", counts.missing_origins}}};
  std::fputs(is_json ? R"(, "stages": {)" : "beyond float32\n", stderr);
  for (const auto& [name, count] : rows) {
    const bool is_last = name == rows.back().first;
    const auto n = static_cast<unsigned long long>(count);
    if (is_json)
      std::fprintf(stderr, "\"%s\": %llu%s", name, n, is_last ? "}}\n" : ", ");
    else
      std::fprintf(stderr, "  %-17s%llu\n", name, n);
  }
}

}  // namespace

double Stopwatch::lap() {
  const Clock::time_point now = Clock::now();
  const double seconds = std::chrono::duration<double>(now - last_).count();
  last_ = now;
  return seconds;
}

void Stopwatch::report(Statistics kind, const Scene& scene, ImageSize size,
                       const RenderCounts& counts, unsigned threads,
                       const MemoryBudget& memory) const {
  if (kind == Statistics::none) return;
  std::size_t primitives = 0;
  for (const ObjectRun& run : scene.objects.runs()) {
    primitives += primitive_count(run);
    // A segment is rendered as two triangles.
    if (const PlacedMesh mesh = run.mesh(0)) primitives += 2 * mesh.arrays->segments.size();
  }
  const auto rays = static_cast<double>(counts.samples);
  const char* format =
      kind == Statistics::json
          ? R"({"objects": %zu, "primitives": %zu, "width": %u, "height": %u, "threads": %u, )"
            R"("load_s": %.6f, "read_s": %.6f, "validate_s": %.6f, "bake_s": %.6f, )"
            R"("build_s": %.6f, "trace_s": %.6f, "denoise_s": %.6f, "render_s": %.6f, "write_s": %.6f, )"
            R"("peak_memory_mib": %.1f, "counted_memory_mib": %.1f, "samples_per_pixel": %u, "rays": %.0f, "rays_per_s": %.0f)"
          : "objects      %zu\nprimitives   %zu\npicture      %u x %u\nthreads      %u\n"
            "load         %.6f s\n  read       %.6f s\n  validate   %.6f s\n  bake       %.6f s\n"
            "build tree   %.6f s\ntrace        %.6f s\ndenoise      %.6f s\nrender       %.6f s\n"
            "write        %.6f s\npeak memory  %.1f MiB, %.1f MiB of it counted\nsamples      %u a "
            "pixel\n"
            "rays         %.0f\nrays/s       %.0f\n";
  std::fprintf(stderr, format, scene.objects.size(), primitives, size.width, size.height, threads,
               load_, load_times_.read, load_times_.validate, load_times_.bake, times_.build,
               times_.trace, times_.denoise, render_, write_, peak_memory_mib(),
               static_cast<double>(memory.peak()) / (1 << 20), counts.samples_per_pixel, rays,
               rays / render_);
  print_rays(counts.rays, kind == Statistics::json);
  print_stages(counts.stages, kind == Statistics::json);
}

}  // namespace microtrace::cli
