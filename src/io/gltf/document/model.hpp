#pragma once
/// The structure of an asset as plain data: the parts of its geometry and their placement.
///
/// After the checks have repaired the asset's JSON, scenes, nodes, meshes, skins, accessors and
/// buffer views are read from this model. Animations, materials, textures, cameras, lights and the
/// objects of extensions are read from the JSON, because animations may change them.

#include "io/gltf/document/asset.hpp"
#include "io/gltf/document/element_types.hpp"

#include <microtrace/math.hpp>

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec4.hpp>

namespace microtrace::io::gltf {

/// Objects refer to each other by index.
struct Model {
  struct BufferView {
    std::size_t buffer = 0, offset = 0, length = 0;
    std::size_t stride = 0;  ///< 0 means tightly packed
  };

  /// Replacements for some of an accessor's elements.
  struct Sparse {
    std::size_t count = 0;
    std::size_t indices_view = 0, indices_offset = 0;
    int index_type = kUint8;
    std::size_t values_view = 0, values_offset = 0;
  };

  /// An accessor of unknown type keeps these default values and is not used by any drawn object.
  struct Accessor {
    ElementType type = ElementType::scalar;
    int component_type = kUint8;  ///< OpenGL constant
    bool normalized = false;
    std::size_t count = 1;
    bool is_empty = false;  ///< true if the file states a count of 0, for which `count` is 1
    std::optional<std::size_t> view{};  ///< if absent, all elements are zeros
    std::size_t offset = 0;             ///< from the start of the view
    std::optional<Sparse> sparse{};
  };

  enum class Mode { points, lines, line_loop, line_strip, triangles, triangle_strip, triangle_fan };

  using Attributes = std::map<std::string, std::size_t>;  ///< accessor indices by attribute name

  struct Primitive {
    Attributes attributes{};
    std::optional<std::size_t> indices{};  ///< index of the accessor with the indices
    std::optional<std::size_t> material{};
    Mode mode = Mode::triangles;
    std::vector<Attributes> targets{};
  };

  struct Mesh {
    std::string name{};
    std::vector<Primitive> primitives{};
    std::vector<double> weights{};
  };

  struct Node {
    std::string name{};
    std::vector<std::size_t> children{};
    std::optional<std::size_t> mesh{}, skin{}, camera{};
    /// If not null, replaces the three properties below.
    std::shared_ptr<const DMat4> matrix{};
    DVec3 translation{0}, scale{1};
    glm::dvec4 rotation{0, 0, 0, 1};  ///< (x, y, z, w), not necessarily of unit length
    std::vector<double> weights{};
    bool has_extensions = false;
  };

  struct Skin {
    std::vector<std::size_t> joints{};
    std::optional<std::size_t> inverse_bind_matrices{};  ///< accessor index
  };

  std::vector<BufferView> buffer_views{};
  std::vector<Accessor> accessors{};
  std::vector<Mesh> meshes{};
  std::vector<Node> nodes{};
  std::vector<Skin> skins{};
  std::vector<std::vector<std::size_t>> scenes{};  ///< root nodes of each scene
  std::size_t scene = 0;  ///< index of the scene to draw, if there are any scenes
};

/// Makes the model of an asset that has passed the checks, and removes members of nodes that only
/// the model needs from the asset. Throws Error (limit).
[[nodiscard]] Model parse_model(Asset& asset);

}  // namespace microtrace::io::gltf
