#pragma once
/// KHR_draco_mesh_compression.

#include "io/gltf/bytes/accessors.hpp"
#include "io/gltf/bytes/buffer_views.hpp"
#include "io/gltf/document/asset.hpp"
#include "io/gltf/document/model.hpp"

#include <cstddef>
#include <map>
#include <utility>

namespace microtrace::io::gltf {

class DracoDecoder {
 public:
  /// All must outlive the decoder.
  DracoDecoder(Asset& asset, const Model& model, const BufferViews& views, AccessorReader& reader)
      : asset_(asset), model_(model), views_(views), reader_(reader) {}

  /// Gives the reader what the compressed bytes of a primitive hold, in place of its accessors'
  /// elements, and of their counts. False where it has none or, with a warning, they can't be
  /// decoded and the asset does not require it. The indices are then of triangles, whatever the
  /// primitive's mode. Throws Error: invalid_scene, limit, unsupported.
  bool decode(const Element& at, const Model::Primitive& primitive);

 private:
  using Source = std::pair<std::size_t, std::size_t>;  // view, Draco's id
  struct Job;

  [[nodiscard]] bool has_module(const Element& at);
  void plan(const Model::Primitive& primitive, Job& job) const;
  void run(Job& job);
  void check_counts(const Job& job, std::size_t points) const;
  [[nodiscard]] const Model::Accessor& accessor(std::size_t index) const;

  Asset& asset_;
  const Model& model_;
  const BufferViews& views_;
  AccessorReader& reader_;
  std::map<std::size_t, Source> sources_;  // of accessors that were replaced
  std::size_t left_ = max_buffer_bytes;    // that may be decoded
};

}  // namespace microtrace::io::gltf
