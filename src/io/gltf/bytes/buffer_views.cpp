#include "io/gltf/bytes/buffer_views.hpp"

#include "io/gltf/bytes/meshopt.hpp"

#include <utility>

namespace microtrace::io::gltf {

BufferViews::BufferViews(Asset& asset, const Model& model, const std::vector<Buffer>& buffers)
    : decoded_(model.buffer_views.size()), bytes_(model.buffer_views.size()) {
  std::size_t left = kMaxBufferBytes;  // remaining limit on decoded bytes
  for (std::size_t i = 0; i < bytes_.size(); ++i) {
    const Model::BufferView& view = model.buffer_views[i];
    if (auto decoded = decode_meshopt(asset, model, i, buffers, left)) {
      decoded_[i] = *std::move(decoded);
      bytes_[i] = decoded_[i];
    } else if (const auto& bytes = buffers[view.buffer].bytes) {
      bytes_[i] = bytes->substr(view.offset, view.length);
    }
  }
}

}  // namespace microtrace::io::gltf
