#include "io/gltf/bytes/meshopt.hpp"

#include "base/memory_account.hpp"
#include "io/gltf/bytes/meshopt_abi.hpp"
#include "io/gltf/bytes/meshopt_extension.hpp"
#include "io/gltf/bytes/meshopt_filters.hpp"
#include "io/gltf/document/extension.hpp"
#include "io/module_function.hpp"

#include <algorithm>
#include <string_view>

namespace microtrace::io::gltf {
namespace {

/// The first byte of attributes of version 1.
constexpr char kAttributesVersion1 = '\xa1';

/// Maximum compression ratio of the formats. In attributes of version 1, 2 bits encode 256 zero
/// bytes; elsewhere, 2 bits encode at most 16 bytes.
std::size_t max_ratio(std::string_view bytes) {
  return bytes.starts_with(kAttributesVersion1) ? 1024 : 64;
}

struct Description {
  MicrotraceMeshoptMode mode = microtrace_meshopt_attributes;
  std::string filter = "NONE";
  std::size_t count = 0, stride = 0;
};

void require(const Asset& asset, const Element& at, bool holds, const char* message) {
  if (!holds) asset.fail(at, message);
}

bool is_filter_allowed(const Description& attributes) {
  const auto& [mode, filter, count, stride] = attributes;
  if (filter == "NONE" || filter == "EXPONENTIAL") return true;
  if (filter == "OCTAHEDRAL" || filter == "COLOR") return stride == 4 || stride == 8;
  return filter == "QUATERNION" && stride == 8;
}

/// Reads and checks the extension's properties.
Description describe(const Asset& asset, const MeshoptObject& object,
                     const Model::BufferView& view) {
  const Element& at = object.at;
  Description result;
  result.count = whole_number(asset, at, "count");
  result.stride = whole_number(asset, at, "byteStride", 256);
  const std::string& mode = string(asset, at, "mode");
  if (at.value->find("filter") != nullptr) result.filter = string(asset, at, "filter");
  require(asset, at, mode == "ATTRIBUTES" || mode == "TRIANGLES" || mode == "INDICES",
          "must have the mode ATTRIBUTES, TRIANGLES or INDICES");
  require(asset, at, view.stride == 0 || view.stride == result.stride,
          "must have the same byteStride as the view");
  require(asset, at,
          result.stride > 0 && view.length % result.stride == 0 &&
              view.length / result.stride == result.count,
          "must have a count that times byteStride gives the view's byteLength");
  if (mode == "ATTRIBUTES") {
    require(asset, at, result.stride % 4 == 0,
            "must have a byteStride that is a multiple of 4 for mode ATTRIBUTES");
    require(asset, at, result.filter != "COLOR" || object.extension == kKhrMeshopt,
            "has the filter COLOR, which only KHR_meshopt_compression allows");
    require(asset, at, is_filter_allowed(result),
            "has a filter that is unknown or not allowed for this byteStride");
    return result;
  }
  result.mode = mode == "TRIANGLES" ? microtrace_meshopt_triangles : microtrace_meshopt_indices;
  require(asset, at, result.stride == 2 || result.stride == 4,
          "must have byteStride 2 or 4 for modes TRIANGLES and INDICES");
  require(asset, at, mode == "INDICES" || result.count % 3 == 0,
          "must have a count that is a multiple of 3 for mode TRIANGLES");
  require(asset, at, result.filter == "NONE", "has a filter, which only mode ATTRIBUTES allows");
  return result;
}

/// Returns the compressed data. Returns nothing if the buffer that should contain them has no data.
std::optional<std::string_view> compressed(const Asset& asset, const Element& at,
                                           const std::vector<Buffer>& buffers) {
  const auto& bytes = buffers[index(asset, at, "buffer", buffers.size())].bytes;
  const bool has_offset = at.value->find("byteOffset") != nullptr;
  const std::size_t offset = has_offset ? whole_number(asset, at, "byteOffset") : 0;
  const std::size_t length = whole_number(asset, at, "byteLength");
  if (!bytes) return std::nullopt;
  if (offset > bytes->size() || length > bytes->size() - offset) {
    asset.fail(at, "ends beyond its buffer of " + std::to_string(bytes->size()) + " bytes");
  }
  return bytes->substr(offset, length);
}

const ModuleFunction& decoder() {
  static const ModuleFunction function =
      find_module_function(kMeshoptModuleFileName, kDecodeMeshoptName);
  return function;
}

}  // namespace

bool can_decode_meshopt() {
  return decoder().address != nullptr;
}

std::optional<std::string> decode_meshopt(Asset& asset, const Model& model, std::size_t view,
                                          const std::vector<Buffer>& buffers, std::size_t& left) {
  const auto object = meshopt_object(asset.element("bufferViews", view));
  if (!object) return std::nullopt;
  const Element& at = object->at;
  const Description description = describe(asset, *object, model.buffer_views[view]);
  const std::optional<std::string_view> bytes = compressed(asset, at, buffers);
  if (!bytes) return std::nullopt;

  if (!can_decode_meshopt()) {
    const std::string message = std::string(object->extension) +
                                " can't be decoded: " + decoder().complaint +
                                "; build the target microtrace_meshopt";
    if (asset.requires_extension(object->extension)) {
      asset.fail(at, message, ErrorKind::unsupported);
    }
    asset.warn(at, message);
    return std::nullopt;
  }

  if (description.mode == microtrace_meshopt_attributes && object->extension == kExtMeshopt &&
      bytes->starts_with(kAttributesVersion1)) {
    asset.fail(at,
               "holds attributes of version 1, which only KHR_meshopt_compression allows; "
               "compress them by version 0");
  }
  const std::size_t size = description.count * description.stride;
  if (size / max_ratio(*bytes) > bytes->size()) {
    asset.fail(at, "states more elements than its bytes can hold");
  }
  if (size > left) {
    asset.fail(at, "brings the decompressed views to more than 4 GiB, the limit", ErrorKind::limit);
  }
  left -= size;
  take_memory(size, "decompressed views");
  std::string result(size, '\0');
  const MicrotraceMeshopt job{.bytes = reinterpret_cast<const unsigned char*>(bytes->data()),
                              .size = bytes->size(),
                              .count = description.count,
                              .stride = description.stride,
                              .mode = description.mode};
  if (reinterpret_cast<MicrotraceDecodeMeshopt>(decoder().address)(&job, result.data()) == 0) {
    asset.fail(at, "holds invalid data for its mode, count and byteStride");
  }
  if (description.filter == "OCTAHEDRAL") decode_octahedral(result, description.stride);
  if (description.filter == "QUATERNION") decode_quaternions(result);
  if (description.filter == "EXPONENTIAL") decode_exponential(result);
  if (description.filter == "COLOR") decode_colors(result, description.stride);
  return result;
}

}  // namespace microtrace::io::gltf
