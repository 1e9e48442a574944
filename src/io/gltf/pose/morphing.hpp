#pragma once
/// Morph targets (glTF 2.0, section 3.7.2.2).

#include "io/gltf/bytes/accessors.hpp"
#include "io/gltf/document/asset.hpp"
#include "io/gltf/document/model.hpp"
#include "io/gltf/mesh/surfaces.hpp"

#include <microtrace/math.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace microtrace::io::gltf {

/// One pose adds at most so many displacements of vertices.
inline constexpr std::size_t max_displacements = std::size_t{1} << 29;
/// What a target of a primitive counts at least: so long it takes to look at it.
inline constexpr std::size_t least_displacements = 64;

/// What stands instead of a mesh's own; each is empty where no target moves it.
struct Morphed {
  std::vector<DVec3> positions{}, normals{}, tangents{};  ///< directions of any length
  std::vector<std::vector<Vec2>> uv_sets{};
  std::vector<Vec4> colors{};
};

/// Adds targets to the vertices of surfaces, in float64.
class Morpher {
 public:
  /// All three must outlive the morpher.
  Morpher(Asset& asset, const Model& model, AccessorReader& reader)
      : asset_(asset), model_(model), reader_(reader) {}

  /// Weights by target; those without one are not applied. Throws Error: invalid_scene, limit.
  [[nodiscard]] Morphed morphed(std::size_t mesh, const Surface& surface,
                                const std::vector<double>& weights);

 private:
  void add(std::size_t accessor, const std::string& name, double weight, const Surface& surface,
           Morphed& result);

  Asset& asset_;
  const Model& model_;
  AccessorReader& reader_;
  std::size_t displacements_ = 0;  // counted against the maximum
};

}  // namespace microtrace::io::gltf
