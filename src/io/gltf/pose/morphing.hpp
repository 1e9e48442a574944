#pragma once
/// Applies morph targets (glTF 2.0, section 3.7.2.2).

#include "io/gltf/bytes/accessors.hpp"
#include "io/gltf/document/asset.hpp"
#include "io/gltf/document/model.hpp"
#include "io/gltf/mesh/surfaces.hpp"

#include <microtrace/array.hpp>
#include <microtrace/math.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace microtrace::io::gltf {

/// The maximum number of vertex displacements in one pose.
inline constexpr std::size_t kMaxDisplacements = std::size_t{1} << 29;
/// Each target of a primitive counts as at least this many displacements, because even an empty
/// target takes time to examine.
inline constexpr std::size_t kLeastDisplacements = 64;

/// Morphed attributes, which replace the mesh's own. An attribute is empty if no target changes it.
struct Morphed {
  std::vector<DVec3> positions{}, normals{}, tangents{};  ///< not normalized
  ShortVector<Array<Vec2>> uv_sets{};
  std::vector<Vec4> colors{};
};

/// Adds weighted morph targets to the vertices of surfaces, in float64.
class Morpher {
 public:
  /// The arguments must outlive the morpher.
  Morpher(Asset& asset, const Model& model, AccessorReader& reader)
      : asset_(asset), model_(model), reader_(reader) {}

  /// Returns the morphed attributes of a surface. `weights` has one number per target. Targets
  /// beyond its end are not applied. Throws Error: invalid_scene, limit.
  [[nodiscard]] Morphed morphed(std::size_t mesh, const Surface& surface,
                                const std::vector<double>& weights);

 private:
  void add(std::size_t accessor, const std::string& name, double weight, const Surface& surface,
           Morphed& result);

  Asset& asset_;
  const Model& model_;
  AccessorReader& reader_;
  std::size_t displacements_ = 0;  // limited by kMaxDisplacements
};

}  // namespace microtrace::io::gltf
