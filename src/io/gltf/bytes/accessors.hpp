#pragma once
/// Decoding of accessors.

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

/// Limit on the elements of an accessor without a buffer view, on the indices of all primitives,
/// and on the triangles and vertices of all mesh instances in a scene.
inline constexpr std::size_t kMaxElements = std::size_t{1} << 27;

/// Decodes accessors that check_accessors has accepted and whose data is present: any component
/// type, interleaved, sparse, or without a buffer view (zeros).
class AccessorReader {
 public:
  /// The arguments must outlive the reader.
  AccessorReader(const Asset& asset, const Model& model, const BufferViews& views);

  /// True if all buffers that the accessor refers to have data.
  [[nodiscard]] bool has_data(std::size_t accessor) const;

  /// Number of elements.
  [[nodiscard]] std::size_t count(std::size_t accessor) const;

  /// All elements of the accessor. Element is float, glm::vec2, Vec3, glm::vec4, glm::mat4,
  /// std::uint32_t or glm::uvec4, and has as many components as the accessor's type. Read as
  /// floats, normalized integers lie in [0, 1] or [-1, 1] (glTF 2.0, section 3.11) and other
  /// integers keep their value, each rounded once. Integers are read from unsigned component types
  /// only. Throws Error (invalid_scene) if sparse indices are out of order or range, and (limit) if
  /// more than kMaxElements have no buffer view.
  template <typename Element>
  [[nodiscard]] std::vector<Element> read(std::size_t accessor);

  /// The elements with these indices, which must not descend. Time and memory depend on their
  /// number, not on the accessor's length. Indices beyond the accessor's count give zeros, because
  /// a compressed primitive may have more vertices than the accessors of its other attributes.
  template <typename Element>
  [[nodiscard]] std::vector<Element> read(std::size_t accessor,
                                          std::span<const std::uint32_t> numbers);

  /// The same, with 0 for each float that is not finite.
  template <typename Element>
  [[nodiscard]] std::vector<Element> read_finite(std::size_t accessor,
                                                 std::span<const std::uint32_t> numbers);

  /// Replaces the accessor's elements by tightly packed ones, decoded from a compressed primitive.
  /// Their number may differ.
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
