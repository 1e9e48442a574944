#include "render/integrators/wavefront/path_recorder.hpp"

#include "scene/math/luminance.hpp"
#include "simd/vector3.hpp"

#include <glm/geometric.hpp>

namespace microtrace {

void PathRecorder::note(const PathColumns& paths, std::size_t count, std::span<const Vec3> colors) {
  for (std::size_t i = 0; i < count; ++i) {
    if (paths.is_scattered[i] != 0) continue;
    const Vec3 d = unit<1>(vector_of(paths.d, i)), n = vector_of(paths.from_n, i);
    const float cosine = glm::dot(d, n);
    const float throughput = luminance(vector_of(paths.throughput, i));
    if (!(cosine > 0) || !(throughput > 0)) continue;
    vertices_.push_back({.p = vector_of(paths.from_p, i),
                         .d = d,
                         .slot = paths.slot[i],
                         .face = static_cast<std::uint32_t>(face_index(SignedAxis::nearest(n))),
                         .factor = cosine / (throughput * paths.pdf[i]),
                         .before = luminance(colors[paths.slot[i]])});
  }
}

void PathRecorder::finish(std::span<const Vec3> colors, GuideRecords& records) {
  for (const Vertex& vertex : vertices_) {
    const float value = (luminance(colors[vertex.slot]) - vertex.before) * vertex.factor;
    records[vertex.face].push_back({.p = vertex.p, .d = vertex.d, .value = value});
  }
  vertices_.clear();
}

}  // namespace microtrace
