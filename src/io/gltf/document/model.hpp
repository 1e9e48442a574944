#pragma once
/// The structure of an asset as plain data: what its geometry is made of and how it is placed.
///
/// The checks work on the asset's JSON and repair it. After them this is the one place to look up
/// scenes, nodes, meshes, skins, accessors and buffer views. Animations, materials, textures,
/// cameras, lights and what extensions add are read from the JSON, where a pose may change them.

#include "io/gltf/document/asset.hpp"
#include "io/gltf/document/element_types.hpp"

#include <microtrace/math.hpp>

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec4.hpp>

namespace microtrace::io::gltf {

/// Objects name each other by index.
struct Model {
  struct BufferView {
    std::size_t buffer = 0, offset = 0, length = 0;
    std::size_t stride = 0;  ///< 0: the elements lie without gaps
  };

  /// Elements of an accessor that other ones replace.
  struct Sparse {
    std::size_t count = 0;
    std::size_t indices_view = 0, indices_offset = 0;
    int index_type = u8;
    std::size_t values_view = 0, values_offset = 0;
  };

  /// One of an unknown type, which nothing that is drawn uses, is as this is made.
  struct Accessor {
    ElementType type = ElementType::scalar;
    int component_type = u8;  ///< OpenGL's number
    bool normalized = false;
    std::size_t count = 1;
    std::optional<std::size_t> view{};  ///< without, all elements are zeros
    std::size_t offset = 0;             ///< within the view
    std::optional<Sparse> sparse{};
  };

  enum class Mode { points, lines, line_loop, line_strip, triangles, triangle_strip, triangle_fan };

  using Attributes = std::map<std::string, std::size_t>;  ///< accessors by name

  struct Primitive {
    Attributes attributes{};
    std::optional<std::size_t> indices{};  ///< an accessor
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
    std::optional<DMat4> matrix{};  ///< stands instead of the three below
    DVec3 translation{0}, scale{1};
    glm::dvec4 rotation{0, 0, 0, 1};  ///< (x, y, z, w), of any length
    std::vector<double> weights{};
  };

  struct Skin {
    std::vector<std::size_t> joints{};
    std::optional<std::size_t> inverse_bind_matrices{};  ///< an accessor
  };

  std::vector<BufferView> buffer_views{};
  std::vector<Accessor> accessors{};
  std::vector<Mesh> meshes{};
  std::vector<Node> nodes{};
  std::vector<Skin> skins{};
  std::vector<std::vector<std::size_t>> scenes{};  ///< their root nodes
  std::size_t scene = 0;                           ///< the one to draw, if there are any
};

/// The model of an asset that the checks have accepted. Throws Error (limit).
[[nodiscard]] Model parse_model(const Asset& asset);

}  // namespace microtrace::io::gltf
