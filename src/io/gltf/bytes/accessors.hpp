#pragma once
/// What accessors hold.

#include "io/gltf/bytes/buffer_views.hpp"
#include "io/gltf/document/asset.hpp"
#include "io/gltf/document/model.hpp"

#include <microtrace/math.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

namespace microtrace::io::gltf {

/// No asset has more elements in an accessor without a buffer view, more indices in all its
/// primitives, and no scene more triangles or vertices in all instances of its meshes.
inline constexpr std::size_t max_elements = std::size_t{1} << 27;

/// Decodes accessors that check_accessors has accepted and whose data is there: of any component
/// type, interleaved, sparse, or without buffer view (zeros).
class AccessorReader {
 public:
  /// All three must outlive the reader.
  AccessorReader(const Asset& asset, const Model& model, const BufferViews& views);

  /// Whether every buffer that the accessor needs has bytes.
  [[nodiscard]] bool has_data(std::size_t accessor) const;

  /// How many elements the accessor has.
  [[nodiscard]] std::size_t count(std::size_t accessor) const;

  /// The accessor's elements. Element is float, glm::vec2, Vec3, glm::vec4, glm::mat4,
  /// std::uint32_t or glm::uvec4, with as many components as the accessor's type. As floats,
  /// normalized integers lie in [0, 1] or [-1, 1] (glTF 2.0, section 3.11), other integers keep
  /// their value; each is rounded once. As integers the component type is an unsigned one. Throws
  /// Error (invalid_scene) where sparse indices are out of order or range,
  /// and (limit) where there are more than max_elements without a buffer view.
  template <typename Element>
  [[nodiscard]] std::vector<Element> read(std::size_t accessor);

  /// The same for some elements only, by numbers that don't descend: as many as a primitive uses,
  /// in time and memory, however long the accessor is. Elements beyond the accessor's count are
  /// zeros: a compressed primitive may have more vertices than the accessors of its other
  /// attributes.
  template <typename Element>
  [[nodiscard]] std::vector<Element> read(std::size_t accessor,
                                          std::span<const std::uint32_t> numbers);

  /// The same with 0 for each float that is not finite.
  template <typename Element>
  [[nodiscard]] std::vector<Element> read_finite(std::size_t accessor,
                                                 std::span<const std::uint32_t> numbers);

  /// From now on the accessor's elements are these, without gaps, as a compressed primitive holds
  /// them; their number may be another than before.
  void replace(std::size_t accessor, std::string elements);

  [[nodiscard]] const BufferViews& views() const { return views_; }

 private:
  struct Source;
  [[nodiscard]] Source source(std::size_t accessor);
  void check_sparse(std::size_t accessor, const Source& source);

  const Asset& asset_;
  const Model& model_;
  const BufferViews& views_;
  std::vector<bool> sparse_is_checked_;                    // by accessor
  std::unordered_map<std::size_t, std::string> replaced_;  // by accessor
};

}  // namespace microtrace::io::gltf
