#pragma once
/// Decodes accessors.

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

/// The maximum for each of several counts: elements of an accessor without a buffer view, indices
/// of all primitives, triangles of all mesh instances, vertices of all mesh instances, and others.
inline constexpr std::size_t kMaxElements = std::size_t{1} << 27;

/// Decodes accessors with any component type: interleaved, sparse, or without a buffer view
/// (zeros). Expects accessors that check_accessors has accepted and whose data is present.
class AccessorReader {
 public:
  /// The arguments must outlive the reader.
  AccessorReader(const Asset& asset, const Model& model, const BufferViews& views);

  /// Returns true if all buffers that the accessor refers to have data.
  [[nodiscard]] bool has_data(std::size_t accessor) const;

  /// Returns the number of elements.
  [[nodiscard]] std::size_t count(std::size_t accessor) const;

  /// Reads all elements of the accessor. Element is float, glm::vec2, Vec3, glm::vec4, glm::mat4,
  /// std::uint32_t or glm::uvec4, with as many components as the accessor's type. If Element
  /// consists of floats, normalized integers are converted to [0, 1] or [-1, 1] (glTF 2.0, section
  /// 3.11), and other integers keep their values. Each number is rounded once. Integers are read
  /// from unsigned component types only. Throws Error (invalid_scene) if sparse indices are out of
  /// order or range, and (limit) if more than kMaxElements have no buffer view.
  template <typename Element>
  [[nodiscard]] std::vector<Element> read(std::size_t accessor);

  /// Reads the elements with these indices, which must not descend. Time and memory depend on the
  /// number of indices, not on the accessor's length. Indices beyond the accessor's count give
  /// zeros, because a compressed primitive may have more vertices than the accessors of its other
  /// attributes.
  template <typename Element>
  [[nodiscard]] std::vector<Element> read(std::size_t accessor,
                                          std::span<const std::uint32_t> numbers);

  /// Does the same, but replaces floats that are not finite by 0.
  template <typename Element>
  [[nodiscard]] std::vector<Element> read_finite(std::size_t accessor,
                                                 std::span<const std::uint32_t> numbers);

  /// Replaces the accessor's elements by tightly packed ones that were decoded from a compressed
  /// primitive. The number of elements may change.
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
