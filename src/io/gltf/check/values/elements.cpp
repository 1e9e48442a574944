#include "io/gltf/check/values/elements.hpp"

#include <cstdint>

namespace microtrace::io::gltf {
namespace {

/// The maximum size in bytes of a sparse accessor that is assembled for checking.
constexpr std::size_t kMaxSparseBytes = std::size_t{1} << 26;

std::uint32_t unsigned_at(std::string_view bytes, std::size_t number, std::size_t size) {
  std::uint32_t result = 0;  // little-endian, like the numbers of glTF
  std::memcpy(&result, &bytes[number * size], size);
  return result;
}

class SparseParts {
 public:
  SparseParts(const Model::Accessor& accessor, const BufferViews& views) : accessor_(accessor) {
    const Model::Sparse& sparse = *accessor.sparse;
    const auto indices = views.bytes(sparse.indices_view), values = views.bytes(sparse.values_view);
    if (!indices || !values) return;
    indices_ = indices->substr(sparse.indices_offset);
    values_ = values->substr(sparse.values_offset);
    count_ = sparse.count;
    index_size_ = component_size(sparse.index_type);
  }

  [[nodiscard]] bool has_data() const { return count_ > 0; }

  void check(const Asset& asset, std::size_t accessor) const {
    std::uint64_t least = 0;  // the next index must be at least this number
    for (std::size_t i = 0; i < count_; ++i) {
      const std::uint32_t target = unsigned_at(indices_, i, index_size_);
      if (target < least || target >= accessor_.count) {
        asset.fail(asset.element("accessors", accessor).member("sparse").member("indices"),
                   "item " + std::to_string(i) + " is " + std::to_string(target) +
                       "; they must ascend and stay below the accessor's count, " +
                       std::to_string(accessor_.count));
      }
      least = std::uint64_t{target} + 1;
    }
  }

  void put_into(std::string& elements, std::size_t size) const {
    for (std::size_t i = 0; i < count_; ++i) {
      std::memcpy(&elements[unsigned_at(indices_, i, index_size_) * size], &values_[i * size],
                  size);
    }
  }

 private:
  const Model::Accessor& accessor_;
  std::string_view indices_, values_;
  std::size_t count_ = 0, index_size_ = 1;
};

}  // namespace

std::optional<Elements> Elements::of(const Asset& asset, const Model& model,
                                     const BufferViews& views, std::size_t index) {
  const Model::Accessor& accessor = model.accessors[index];
  const std::size_t size = element_size(accessor.type, accessor.component_type);
  Elements result;
  result.count_ = accessor.count;
  result.component_type_ = accessor.component_type;
  result.components_ = component_count(accessor.type);
  result.stride_ = size;
  if (size != result.components_ * component_size(accessor.component_type)) {
    return std::nullopt;  // no check reads matrices of small integers, which have padded columns
  }
  if (accessor.view) {
    const std::optional<std::string_view> bytes = views.bytes(*accessor.view);
    if (!bytes) return std::nullopt;
    result.bytes_ = bytes->substr(accessor.offset);
    const std::size_t stride = model.buffer_views[*accessor.view].stride;
    if (stride != 0) result.stride_ = stride;
  }
  if (!accessor.sparse) {
    return accessor.view ? std::optional(std::move(result)) : std::nullopt;
  }
  const SparseParts sparse(accessor, views);
  if (!sparse.has_data()) return std::nullopt;
  sparse.check(asset, index);
  if (accessor.count > kMaxSparseBytes / size) return std::nullopt;
  result.storage_.resize(accessor.count * size);
  for (std::size_t i = 0; accessor.view && i < accessor.count; ++i) {
    std::memcpy(&result.storage_[i * size], &result.bytes_[i * result.stride_], size);
  }
  sparse.put_into(result.storage_, size);
  result.stride_ = size;
  return result;
}

double Elements::number(std::size_t element, std::size_t component) const {
  switch (component_type_) {
    case kInt8:
      return at<std::int8_t>(element, component);
    case kUint8:
      return at<std::uint8_t>(element, component);
    case kInt16:
      return at<std::int16_t>(element, component);
    case kUint16:
      return at<std::uint16_t>(element, component);
    case kUint32:
      return at<std::uint32_t>(element, component);
    default:
      return static_cast<double>(at<float>(element, component));
  }
}

}  // namespace microtrace::io::gltf
