#pragma once
/// Accessors: where they lie, whether they fit, and what they hold.

#include "io/gltf/asset.hpp"
#include "io/gltf/buffers.hpp"
#include "io/gltf/model.hpp"

#include <microtrace/math.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace microtrace::io::gltf {

/// Bytes of one component; of one element, with the padding of matrix columns to 4 bytes.
[[nodiscard]] std::size_t component_size(int component_type);
[[nodiscard]] std::size_t element_size(int type, int component_type);

/// Checks every buffer view and accessor of the model: in range, aligned, strides wide enough, the
/// shape of sparse parts (glTF 2.0, sections 3.6.2.4 and 3.6.2.3). Throws Error (invalid_scene).
void check_accessors(const Asset& asset, const tinygltf::Model& model);

/// Decodes accessors that check_accessors has accepted and whose data is there.
class AccessorReader {
 public:
  /// All three must outlive the reader.
  AccessorReader(const Asset& asset, const tinygltf::Model& model,
                 const std::vector<Buffer>& buffers)
      : asset_(asset), model_(model), buffers_(buffers), positions_(model.accessors.size()) {}

  /// Whether every buffer that the accessor needs has bytes.
  [[nodiscard]] bool has_data(int accessor) const;

  /// The vectors of a VEC3 float accessor; kept, so that meshes may share it.
  [[nodiscard]] const std::vector<Vec3>& positions(int accessor);

  /// The integers of a SCALAR accessor of unsigned integers.
  [[nodiscard]] std::vector<std::uint32_t> indices(int accessor) const;

 private:
  /// The elements without gaps, sparse ones put in their places. Throws Error where a sparse index
  /// is out of order or range.
  [[nodiscard]] std::string elements(int accessor) const;
  void apply_sparse(int accessor, std::string& elements) const;
  [[nodiscard]] std::string_view bytes_of_view(int view) const;

  const Asset& asset_;
  const tinygltf::Model& model_;
  const std::vector<Buffer>& buffers_;
  std::vector<std::vector<Vec3>> positions_;  // by accessor; empty until asked for
};

}  // namespace microtrace::io::gltf
