#pragma once
/// The bytes of buffer views.

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
  /// Of views that check_accessors has accepted; compressed ones are decoded. The buffers must
  /// outlive this. Throws Error: invalid_scene, limit, unsupported.
  BufferViews(Asset& asset, const Model& model, const std::vector<Buffer>& buffers);

  /// Nothing where the view's buffer has no data.
  [[nodiscard]] std::optional<std::string_view> bytes(std::size_t view) const {
    return bytes_[view];
  }

 private:
  std::vector<std::string> decoded_;                    // by view; empty if it is not compressed
  std::vector<std::optional<std::string_view>> bytes_;  // by view
};

}  // namespace microtrace::io::gltf
