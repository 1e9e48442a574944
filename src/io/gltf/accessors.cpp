#include "io/gltf/accessors.hpp"

#include <bit>
#include <cstring>

namespace microtrace::io::gltf {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF's numbers are copied as they lie");

template <typename Integer>
std::uint32_t load(const char* bytes) {
  Integer value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

std::uint32_t load_unsigned(const char* bytes, int component_type) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return load<std::uint8_t>(bytes);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return load<std::uint16_t>(bytes);
    default:
      return load<std::uint32_t>(bytes);
  }
}

}  // namespace

std::string_view AccessorReader::bytes_of_view(int view) const {
  const auto index = static_cast<std::size_t>(view);
  const tinygltf::BufferView& buffer_view = model_.bufferViews[index];
  const auto& bytes = buffers_[static_cast<std::size_t>(buffer_view.buffer)].bytes;
  return bytes.value().substr(buffer_view.byteOffset, buffer_view.byteLength);
}

bool AccessorReader::has_data(int index) const {
  const tinygltf::Accessor& accessor = model_.accessors[static_cast<std::size_t>(index)];
  const auto has_bytes = [this](int view) {
    const int buffer = model_.bufferViews[static_cast<std::size_t>(view)].buffer;
    return buffers_[static_cast<std::size_t>(buffer)].bytes.has_value();
  };
  return (accessor.bufferView < 0 || has_bytes(accessor.bufferView)) &&
         (!accessor.sparse.isSparse || (has_bytes(accessor.sparse.indices.bufferView) &&
                                        has_bytes(accessor.sparse.values.bufferView)));
}

std::string AccessorReader::elements(int index) const {
  const tinygltf::Accessor& accessor = model_.accessors[static_cast<std::size_t>(index)];
  const std::size_t size = element_size(accessor.type, accessor.componentType);
  std::string result(accessor.count * size, '\0');
  if (accessor.bufferView >= 0) {
    const std::string_view bytes = bytes_of_view(accessor.bufferView);
    const auto view = static_cast<std::size_t>(accessor.bufferView);
    const std::size_t given = model_.bufferViews[view].byteStride;
    const std::size_t stride = given != 0 ? given : size;
    for (std::size_t i = 0; i < accessor.count; ++i) {
      std::memcpy(&result[i * size], &bytes[accessor.byteOffset + i * stride], size);
    }
  }
  if (accessor.sparse.isSparse) apply_sparse(index, result);
  return result;
}

void AccessorReader::apply_sparse(int index, std::string& elements) const {
  const tinygltf::Accessor& accessor = model_.accessors[static_cast<std::size_t>(index)];
  const auto& sparse = accessor.sparse;
  const std::size_t size = element_size(accessor.type, accessor.componentType);
  const std::size_t index_size = component_size(sparse.indices.componentType);
  const std::string_view indices = bytes_of_view(sparse.indices.bufferView)
                                       .substr(static_cast<std::size_t>(sparse.indices.byteOffset));
  const std::string_view values = bytes_of_view(sparse.values.bufferView)
                                      .substr(static_cast<std::size_t>(sparse.values.byteOffset));
  std::uint64_t least = 0;  // of what the next index may be
  for (std::size_t i = 0; i < static_cast<std::size_t>(sparse.count); ++i) {
    const std::uint32_t target =
        load_unsigned(&indices[i * index_size], sparse.indices.componentType);
    if (target < least || target >= accessor.count) {
      asset_.fail(asset_.element("accessors", static_cast<std::size_t>(index))
                      .member("sparse")
                      .member("indices"),
                  "number " + std::to_string(i) + " is " + std::to_string(target) +
                      "; they must ascend and stay below the accessor's count, " +
                      std::to_string(accessor.count));
    }
    std::memcpy(&elements[target * size], &values[i * size], size);
    least = std::uint64_t{target} + 1;
  }
}

const std::vector<Vec3>& AccessorReader::positions(int accessor) {
  std::vector<Vec3>& result = positions_[static_cast<std::size_t>(accessor)];
  if (result.empty()) {
    const std::string bytes = elements(accessor);
    result.resize(bytes.size() / sizeof(Vec3));
    std::memcpy(result.data(), bytes.data(), bytes.size());
  }
  return result;
}

std::vector<std::uint32_t> AccessorReader::indices(int index) const {
  const tinygltf::Accessor& accessor = model_.accessors[static_cast<std::size_t>(index)];
  const std::string bytes = elements(index);
  const std::size_t size = component_size(accessor.componentType);
  std::vector<std::uint32_t> result(accessor.count);
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[i] = load_unsigned(&bytes[i * size], accessor.componentType);
  }
  return result;
}

}  // namespace microtrace::io::gltf
