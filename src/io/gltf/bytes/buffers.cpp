#include "io/gltf/bytes/buffers.hpp"

#include "base/memory_account.hpp"
#include "io/gltf/bytes/meshopt.hpp"
#include "io/gltf/bytes/meshopt_extension.hpp"
#include "io/gltf/bytes/resource.hpp"
#include "io/gltf/bytes/uri.hpp"
#include "io/gltf/document/properties.hpp"

namespace microtrace::io::gltf {
namespace {

std::string decode(Asset& asset, const Element& uri) {
  const std::optional<DataUri> data = split_data_uri(uri.value->string());
  if (data && data->media_type != "application/octet-stream" &&
      data->media_type != "application/gltf-buffer") {
    asset.tolerate(uri, "has a media type that is not for buffers; use application/octet-stream");
  }
  return decode_data_uri(asset, uri);
}

/// Returns true if the buffer's data is in the BIN chunk of a GLB file. This is the case for the
/// first buffer, if it has no URI.
bool is_bin(std::size_t index, const JsonValue& buffer) {
  return index == 0 && buffer.find("uri") == nullptr;
}

/// Returns true for a fallback buffer. Each of its views also has compressed data, which is read
/// instead.
bool is_fallback(const Element& buffer) {
  const auto compression = meshopt_object(buffer);
  if (!compression) return false;
  const JsonValue* fallback = compression->at.value->find("fallback");
  return fallback != nullptr && fallback->boolean();
}

/// Warns about a buffer without data. This is not an error, because an extension may supply the
/// data.
void missing(Asset& asset, const Element& buffer, bool is_bin) {
  if (is_bin) {
    asset.tolerate(buffer, "has no uri, but the file has no BIN chunk");
  } else {
    asset.warn(buffer, "has no uri and therefore no data");
  }
}

void check_total(const Asset& asset, const std::vector<JsonValue>& buffers) {
  double total = 0;
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    total += buffers[i].find("byteLength")->number();
    if (total > static_cast<double>(kMaxBufferBytes)) {
      asset.fail(asset.element("buffers", i).member("byteLength"),
                 "brings the buffers to more than 4 GiB, the limit", ErrorKind::limit);
    }
  }
}

/// Cuts or extends the data to the stated length. Some exporters count the padding to a multiple of
/// 4 bytes but don't write it.
void set_length(Asset& asset, const Element& at, Buffer& buffer) {
  const auto length = index_from(*at.value);
  const std::size_t size = buffer.bytes->size();
  if (size < length) {
    const std::string problem = "states " + std::to_string(length) +
                                " bytes, but the buffer's data has only " + std::to_string(size);
    if (length - size > 3) asset.fail(at, problem);
    asset.tolerate(at, problem + "; the others are zero");
    if (buffer.storage.empty()) take_memory(length, "the data of buffers");
    buffer.storage = std::string(*buffer.bytes).append(length - size, '\0');
    buffer.bytes = buffer.storage;
  }
  if (length < buffer.storage.size() / 2) {
    memory_account().give_back(buffer.storage.size() - length);
    buffer.storage.resize(length);
    buffer.storage.shrink_to_fit();
    buffer.bytes = buffer.storage;
  }
  buffer.bytes = buffer.bytes->substr(0, length);
}

}  // namespace

std::vector<Buffer> load_buffers(Asset& asset, std::optional<std::string_view> bin, bool is_glb,
                                 const ResourceFolders& folders) {
  const std::vector<JsonValue>& buffers = asset.array("buffers");
  check_total(asset, buffers);
  if (bin && (buffers.empty() || !is_bin(0, buffers[0]))) {
    asset.warn(asset.root(), "the file's BIN chunk belongs to no buffer; it is ignored");
  }
  std::vector<Buffer> result(buffers.size());
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    Buffer& buffer = result[i];
    const Element at = asset.element("buffers", i);
    const Element uri = at.member("uri");
    if (bin && is_bin(i, buffers[i])) {
      buffer.bytes = *bin;
    } else if (is_fallback(at) && can_decode_meshopt()) {
      if (buffers[i].find("uri") != nullptr) note_unread_resource(uri, folders);
      continue;
    } else if (buffers[i].find("uri") != nullptr) {
      tolerate_stray_percent(asset, uri);
      buffer.storage = is_data_uri(uri.value->string())
                           ? decode(asset, uri)
                           : read_resource(asset, uri, folders, "buffer", kMaxBufferBytes);
      buffer.bytes = buffer.storage;
    } else {
      missing(asset, at, i == 0 && is_glb);
      continue;
    }
    set_length(asset, at.member("byteLength"), buffer);
  }
  return result;
}

}  // namespace microtrace::io::gltf
