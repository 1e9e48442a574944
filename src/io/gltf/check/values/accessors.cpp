#include "io/gltf/check/values/accessors.hpp"

#include "io/gltf/bytes/accessors.hpp"

#include <cstdint>
#include <utility>

namespace microtrace::io::gltf {
namespace {

using Size =
    std::uint64_t;  // numbers are at most 2^53 and strides 252: no sum or product overflows

class Checker {
 public:
  Checker(Asset& asset, const tinygltf::Model& model) : asset_(asset), model_(model) {}

  void view(std::size_t index) const {
    const tinygltf::BufferView& view = model_.bufferViews[index];
    const Element at = asset_.element("bufferViews", index);
    const auto buffer = static_cast<std::size_t>(view.buffer);
    const auto length =
        static_cast<Size>(asset_.element("buffers", buffer).member("byteLength").value->number);
    const Size end = Size{view.byteOffset} + view.byteLength;
    if (end > length) {
      asset_.fail(at, "ends at byte " + std::to_string(end) + " of a buffer of " +
                          std::to_string(length) + " bytes");
    }
  }

  void accessor(std::size_t index) const {
    const tinygltf::Accessor& accessor = model_.accessors[index];
    const Element at = asset_.element("accessors", index);
    const Size size = element_size(accessor.type, accessor.componentType);
    const Size extent = element_extent(accessor.type, accessor.componentType);
    if (accessor.bufferView >= 0) {
      const auto view = static_cast<std::size_t>(accessor.bufferView);
      const Size stride = model_.bufferViews[view].byteStride;
      if (stride != 0 && stride < extent) {
        asset_.fail(at, "has elements of " + std::to_string(extent) + " bytes, but its view's " +
                            "byteStride is " + std::to_string(stride));
      }
      fits(at, view, accessor.byteOffset, accessor.count, stride != 0 ? stride : size, extent);
      aligned(at, view, accessor.byteOffset, component_size(accessor.componentType));
    }
    if (accessor.sparse.isSparse) sparse(at.member("sparse"), accessor, size, extent);
  }

 private:
  void sparse(const Element& at, const tinygltf::Accessor& accessor, Size size, Size extent) const {
    const Size count = static_cast<Size>(at.member("count").value->number);
    if (count > accessor.count) {
      asset_.fail(at.member("count"), "replaces " + std::to_string(count) + " of only " +
                                          std::to_string(accessor.count) + " elements");
    }
    const Size index_size = component_size(accessor.sparse.indices.componentType);
    sparse_part(at.member("indices"), count, index_size, index_size, index_size);
    sparse_part(at.member("values"), count, size, extent, component_size(accessor.componentType));
  }

  void sparse_part(const Element& at, Size count, Size size, Size extent, Size alignment) const {
    const auto view = static_cast<std::size_t>(at.member("bufferView").value->number);
    const JsonValue* offset = at.value->find("byteOffset");
    const Size first = offset != nullptr ? static_cast<Size>(offset->number) : 0;
    if (first > INT32_MAX) {  // tinygltf keeps it in an int
      asset_.fail(at.member("byteOffset"), "is beyond 2 GiB; move the view instead",
                  ErrorKind::limit);
    }
    if (model_.bufferViews[view].byteStride != 0) {
      asset_.fail(at.member("bufferView"),
                  "refers to a view with byteStride; sparse parts lie "
                  "without gaps");
    }
    fits(at, view, first, count, size, extent);
    aligned(at, view, first, alignment);
  }

  void fits(const Element& at, std::size_t view, Size offset, Size count, Size stride,
            Size extent) const {
    const Size end = offset + stride * (count - 1) + extent;
    const Size length = model_.bufferViews[view].byteLength;
    if (end > length) {
      asset_.fail(at, "needs " + std::to_string(end) + " bytes of /bufferViews/" +
                          std::to_string(view) + ", which has " + std::to_string(length));
    }
  }

  void aligned(const Element& at, std::size_t view, Size offset, Size alignment) const {
    const Size start = model_.bufferViews[view].byteOffset + offset;
    if (offset % alignment != 0 || start % alignment != 0) {
      asset_.tolerate(
          at, "is not aligned: its offsets in the view and the buffer must be multiples of " +
                  std::to_string(alignment));
    }
  }

  Asset& asset_;
  const tinygltf::Model& model_;
};

}  // namespace

std::size_t component_size(int component_type) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 2;
    default:
      return 4;
  }
}

namespace {

/// The columns of a matrix type, or 0, and the components of a column or vector.
std::pair<std::size_t, std::size_t> shape_of(int type) {
  switch (type) {
    case TINYGLTF_TYPE_SCALAR:
      return {0, 1};
    case TINYGLTF_TYPE_VEC2:
      return {0, 2};
    case TINYGLTF_TYPE_VEC3:
      return {0, 3};
    case TINYGLTF_TYPE_VEC4:
      return {0, 4};
    case TINYGLTF_TYPE_MAT2:
      return {2, 2};
    case TINYGLTF_TYPE_MAT3:
      return {3, 3};
    default:
      return {4, 4};
  }
}

}  // namespace

std::size_t element_size(int type, int component_type) {
  const auto [columns, rows] = shape_of(type);
  const std::size_t size = rows * component_size(component_type);
  return columns == 0 ? size : columns * ((size + 3) / 4 * 4);
}

std::size_t element_extent(int type, int component_type) {
  const auto [columns, rows] = shape_of(type);
  const std::size_t size = rows * component_size(component_type);
  return columns == 0 ? size : (columns - 1) * ((size + 3) / 4 * 4) + size;
}

void check_accessors(Asset& asset, const tinygltf::Model& model) {
  Checker checker(asset, model);
  for (std::size_t i = 0; i < model.bufferViews.size(); ++i) checker.view(i);
  for (std::size_t i = 0; i < model.accessors.size(); ++i) checker.accessor(i);
}

}  // namespace microtrace::io::gltf
