#pragma once
#include "render/guiding/path_guide.hpp"
#include "render/integrators/wavefront/path_state.hpp"

#include <microtrace/math.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace microtrace {

/// Records the light that arrives at the vertices of a wavefront's paths.
class PathRecorder {
 public:
  /// Notes the vertices that the paths left. `colors` is the light that the paths have found so
  /// far, by PathColumns::slot.
  void note(const PathColumns& paths, std::size_t count, std::span<const Vec3> colors);
  /// Adds records to `records` for the vertices since the last call. `colors` is all light that the
  /// paths have found.
  void finish(std::span<const Vec3> colors, GuideRecords& records);

 private:
  struct Vertex {
    Vec3 p, d;
    std::uint32_t slot, face;
    float factor;  ///< factor of light that the path finds later
    float before;  ///< light that the path found before
  };
  std::vector<Vertex> vertices_;
};

}  // namespace microtrace
