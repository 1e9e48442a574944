#pragma once
/// Buffer views, decompressed if necessary.

#include "io/gltf/bytes/buffers.hpp"
#include "io/gltf/document/asset.hpp"
#include "io/gltf/document/model.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace microtrace::io::gltf {

class BufferViews {
 public:
  /// Expects views that check_accessors has accepted, and decodes compressed ones. The buffers must
  /// outlive this object. Throws Error: invalid_scene, limit, unsupported.
  BufferViews(Asset& asset, const Model& model, const std::vector<Buffer>& buffers);

  /// Returns nothing if the view's buffer has no data.
  [[nodiscard]] std::optional<std::string_view> bytes(std::size_t view) const {
    return bytes_[view];
  }

 private:
  std::vector<std::string> decoded_;  // by view; empty unless the view is compressed
  std::vector<std::optional<std::string_view>> bytes_;  // by view
};

}  // namespace microtrace::io::gltf
