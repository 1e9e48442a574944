#include "base/system/float_environment.hpp"
#include "scene/mesh/segment_widener.hpp"

#include <microtrace/segments.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace microtrace {
namespace {

/// The source of a new vertex's attributes: one vertex of the old mesh, or a mixture of two.
struct Source {
  std::uint32_t from, to;
  double t;  // weight of `to`
};

/// Appends the values of each wide segment's four vertices to those of the existing vertices.
template <typename Value, typename Mix>
void extend(Array<Value>& array, const std::vector<Source>& sources, Mix&& mix) {
  if (array.empty()) return;
  std::vector<Value>& values = array.edit();
  values.reserve(values.size() + 2 * sources.size());
  for (const Source& source : sources) {
    const Value value = mix(values[source.from], values[source.to], source.t);
    values.insert(values.end(), 2, value);
  }
}

/// Interpolates colors and texture coordinates along the segment.
template <typename Value>
Value between(const Value& a, const Value& b, double t) {
  return a + (b - a) * static_cast<float>(t);
}

/// Takes a direction from the nearer end, because interpolation would change its length.
template <typename Value>
Value nearer(const Value& a, const Value& b, double t) {
  return t < 0.5 ? a : b;
}

void widen(Mesh& mesh, const SegmentWidener& widened) {
  const Vec3 nowhere(std::numeric_limits<float>::quiet_NaN());
  std::vector<Source> sources;  // one for every two new vertices
  sources.reserve(2 * mesh.segments.size());
  mesh.positions.reserve(mesh.positions.size() + 4 * mesh.segments.size());
  mesh.triangles.reserve(mesh.triangles.size() + 2 * mesh.segments.size());
  for (const auto& [a, b] : mesh.segments) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const auto wide = widened(mesh.positions[a], mesh.positions[b]);
    sources.push_back({.from = a, .to = b, .t = wide ? wide->start : 0});
    sources.push_back({.from = a, .to = b, .t = wide ? wide->end : 1});
    for (std::size_t i = 0; i < 4; ++i) {
      mesh.positions.push_back(wide ? wide->corners[i] : nowhere);
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  }
  mesh.segments.clear();
  extend(mesh.normals, sources, nearer<Vec3>);
  extend(mesh.tangents, sources, nearer<Vec4>);
  extend(mesh.colors, sources, between<Vec4>);
  for (Array<Vec2>& set : mesh.uv_sets) extend(set, sources, between<Vec2>);
}

}  // namespace

bool has_segments(const Scene& scene) {
  for (const ObjectRun& run : scene.objects.runs())
    if (const PlacedMesh mesh = run.mesh(0); mesh && !mesh.arrays->segments.empty()) return true;
  return false;
}

void widen_segments(Scene& scene, const Camera& camera, ImageSize size) {
  const FloatEnvironment environment;
  const SegmentWidener widened(camera, size);
  for (Object& object : scene.objects) {
    auto* mesh = std::get_if<Mesh>(&object.shape);
    if (mesh != nullptr && !mesh->segments.empty()) widen(*mesh, widened);
  }
}

}  // namespace microtrace
