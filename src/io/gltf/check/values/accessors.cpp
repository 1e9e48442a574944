#include "io/gltf/check/values/accessors.hpp"

#include <cstdint>
#include <string>

namespace microtrace::io::gltf {
namespace {

// Sums and products can't overflow: numbers are at most 2^53, strides at most 252.
using Size = std::uint64_t;

class Checker {
 public:
  Checker(Asset& asset, const Model& model) : asset_(asset), model_(model) {}

  void view(std::size_t index) const {
    const Model::BufferView& view = model_.buffer_views[index];
    const Element at = asset_.element("bufferViews", index);
    const auto length = static_cast<Size>(
        asset_.element("buffers", view.buffer).member("byteLength").value->number());
    const Size end = Size{view.offset} + view.length;
    if (end > length) {
      asset_.fail(at, "ends at byte " + std::to_string(end) + " of a buffer of " +
                          std::to_string(length) + " bytes");
    }
  }

  void accessor(std::size_t index) const {
    const Model::Accessor& accessor = model_.accessors[index];
    const Element at = asset_.element("accessors", index);
    const Size size = element_size(accessor.type, accessor.component_type);
    const Size extent = element_extent(accessor.type, accessor.component_type);
    if (accessor.view) {
      const Size stride = model_.buffer_views[*accessor.view].stride;
      if (stride != 0 && stride < extent) {
        asset_.fail(at, "has elements of " + std::to_string(extent) + " bytes, but its view's " +
                            "byteStride is " + std::to_string(stride));
      }
      fits(at, *accessor.view, accessor.offset, accessor.count, stride != 0 ? stride : size,
           extent);
      aligned(at, *accessor.view, accessor.offset, component_size(accessor.component_type));
    }
    if (accessor.sparse) sparse(at.member("sparse"), accessor, size, extent);
  }

 private:
  void sparse(const Element& at, const Model::Accessor& accessor, Size size, Size extent) const {
    const Model::Sparse& sparse = *accessor.sparse;
    if (sparse.count > accessor.count) {
      asset_.fail(at.member("count"), "replaces " + std::to_string(sparse.count) + " of only " +
                                          std::to_string(accessor.count) + " elements");
    }
    const Size index_size = component_size(sparse.index_type);
    const auto part = [&](const char* key, std::size_t view, Size offset, Size stride, Size last,
                          Size alignment) {
      const Element part_at = at.member(key);
      if (model_.buffer_views[view].stride != 0) {
        asset_.fail(part_at.member("bufferView"),
                    "refers to a view with byteStride, but sparse data must be "
                    "tightly packed");
      }
      fits(part_at, view, offset, sparse.count, stride, last);
      aligned(part_at, view, offset, alignment);
    };
    part("indices", sparse.indices_view, sparse.indices_offset, index_size, index_size, index_size);
    part("values", sparse.values_view, sparse.values_offset, size, extent,
         component_size(accessor.component_type));
  }

  void fits(const Element& at, std::size_t view, Size offset, Size count, Size stride,
            Size extent) const {
    const Size end = offset + stride * (count - 1) + extent;
    const Size length = model_.buffer_views[view].length;
    if (end > length) {
      asset_.fail(at, "needs " + std::to_string(end) + " bytes of /bufferViews/" +
                          std::to_string(view) + ", which has " + std::to_string(length));
    }
  }

  void aligned(const Element& at, std::size_t view, Size offset, Size alignment) const {
    const Size start = model_.buffer_views[view].offset + offset;
    if (offset % alignment != 0 || start % alignment != 0) {
      asset_.tolerate(
          at, "is not aligned: its offsets in the view and the buffer must be multiples of " +
                  std::to_string(alignment));
    }
  }

  Asset& asset_;
  const Model& model_;
};

}  // namespace

void check_accessors(Asset& asset, const Model& model) {
  Checker checker(asset, model);
  for (std::size_t i = 0; i < model.buffer_views.size(); ++i) checker.view(i);
  for (std::size_t i = 0; i < model.accessors.size(); ++i) checker.accessor(i);
}

}  // namespace microtrace::io::gltf
