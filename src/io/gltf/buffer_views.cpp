#include "io/gltf/buffer_views.hpp"

namespace microtrace::io::gltf {

BufferViews::BufferViews(const tinygltf::Model& model, const std::vector<Buffer>& buffers) {
  for (const tinygltf::BufferView& view : model.bufferViews) {
    const auto& bytes = buffers[static_cast<std::size_t>(view.buffer)].bytes;
    bytes_.push_back(bytes ? std::optional(bytes->substr(view.byteOffset, view.byteLength))
                           : std::nullopt);
  }
}

}  // namespace microtrace::io::gltf
