#pragma once
/// Decodes KHR_draco_mesh_compression.

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
  /// The arguments must outlive the decoder.
  DracoDecoder(Asset& asset, const Model& model, const BufferViews& views, AccessorReader& reader)
      : asset_(asset), model_(model), views_(views), reader_(reader) {}

  /// Decodes a compressed primitive, and replaces the elements and counts of its accessors in the
  /// AccessorReader. Returns false if the primitive is not compressed. Also returns false, with a
  /// warning, if the primitive can't be decoded and the asset doesn't require the extension.
  /// Decoded indices form triangles, whatever the primitive's mode. Throws Error: invalid_scene,
  /// limit, unsupported.
  bool decode(const Element& at, const Model::Primitive& primitive);

 private:
  using Source = std::pair<std::size_t, std::size_t>;  // buffer view, Draco's attribute id
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
  std::map<std::size_t, Source> sources_;  // source of each replaced accessor's elements
  std::size_t left_ = kMaxBufferBytes;     // remaining limit on decoded bytes
};

}  // namespace microtrace::io::gltf
