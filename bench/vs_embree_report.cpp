#include "vs_embree_report.hpp"

#include <cstdio>
#include <initializer_list>
#include <utility>

namespace microtrace::bench {
namespace {

template <class... T>
std::string print(const char* format, T... values) {
  std::string line(static_cast<std::size_t>(std::snprintf(nullptr, 0, format, values...)), ' ');
  std::snprintf(line.data(), line.size() + 1, format, values...);
  return line;
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return out + '"';
}

std::string number(double x) {
  return print("%.6g", x);
}

std::string object(std::initializer_list<std::pair<const char*, std::string>> members) {
  std::string out;
  for (const auto& [key, value] : members)
    out += (out.empty() ? "{\"" : ", \"") + std::string(key) + "\": " + value;
  return out + "}";
}

std::string object(const BuildRow& row) {
  return object({{"scene", quoted(row.scene)},
                 {"kind", quoted("build")},
                 {"threads", std::to_string(row.threads)},
                 {"triangles", std::to_string(row.triangles)},
                 {"ms_microtrace", number(row.ms_microtrace)},
                 {"ms_embree", number(row.ms_embree)},
                 {"ms_embree_medium", number(row.ms_embree_medium)},
                 {"ratio", number(row.ms_microtrace / row.ms_embree)},
                 {"ratio_medium", number(row.ms_microtrace / row.ms_embree_medium)},
                 {"bytes_per_triangle_microtrace", number(row.bytes_per_triangle_microtrace)},
                 {"bytes_per_triangle_embree", number(row.bytes_per_triangle_embree)}});
}

std::string object(const RayRow& row) {
  return object({{"scene", quoted(row.scene)},
                 {"kind", quoted(row.kind)},
                 {"threads", std::to_string(row.threads)},
                 {"rays", std::to_string(row.rays)},
                 {"mrays_microtrace", number(row.mrays_microtrace)},
                 {"mrays_embree_fast", number(row.mrays_embree_fast)},
                 {"mrays_embree_robust", number(row.mrays_embree_robust)},
                 {"ratio_fast", number(row.mrays_microtrace / row.mrays_embree_fast)},
                 {"ratio_robust", number(row.mrays_microtrace / row.mrays_embree_robust)},
                 {"mode_fast", quoted(row.mode_fast)},
                 {"mode_robust", quoted(row.mode_robust)},
                 {"disagreements_fast", number(row.disagreements_fast)},
                 {"disagreements_robust", number(row.disagreements_robust)},
                 {"float64_edges_per_ray", number(row.edges)},
                 {"float64_filters_per_ray", number(row.filters)},
                 {"exact_per_ray", number(row.exact)}});
}

}  // namespace

std::string table_head() {
  return print("%-17s %-10s %9s %11s %11s %13s %7s %8s %9s %8s %8s %8s  %s\n", "scene", "kind",
               "rays", "microtrace", "Embree fast", "Embree robust", "x fast", "x robust", "differ",
               "edges", "filters", "exact", "Embree's best: fast / robust");
}

std::string table_lines(const SceneRows& rows) {
  const BuildRow& build = rows.build;
  std::string lines = print(
      "%-17s %-10s %9zu %8.0f ms %8.0f ms %13s %7.2f  triangles, %.1f and %.1f bytes each; "
      "medium quality %.0f ms, x %.2f\n",
      build.scene.c_str(), "build", build.triangles, build.ms_microtrace, build.ms_embree, "",
      build.ms_embree / build.ms_microtrace, build.bytes_per_triangle_microtrace,
      build.bytes_per_triangle_embree, build.ms_embree_medium,
      build.ms_embree_medium / build.ms_microtrace);
  for (const RayRow& row : rows.rays)
    lines += print(
        "%-17s %-10s %9zu %6.2f Mr/s %6.2f Mr/s %8.2f Mr/s %7.2f %8.2f %9.2g %8.1g %8.1g %8.1g  %s "
        "/ %s\n",
        row.scene.c_str(), row.kind.c_str(), row.rays, row.mrays_microtrace, row.mrays_embree_fast,
        row.mrays_embree_robust, row.mrays_microtrace / row.mrays_embree_fast,
        row.mrays_microtrace / row.mrays_embree_robust, row.disagreements_fast, row.edges,
        row.filters, row.exact, row.mode_fast.c_str(), row.mode_robust.c_str());
  return lines;
}

std::string json(std::span<const SceneRows> scenes) {
  std::string out;
  for (const SceneRows& rows : scenes) {
    out += (out.empty() ? "[\n  " : ",\n  ") + object(rows.build);
    for (const RayRow& row : rows.rays) out += ",\n  " + object(row);
  }
  return out.empty() ? "[]\n" : out + "\n]\n";
}

}  // namespace microtrace::bench
