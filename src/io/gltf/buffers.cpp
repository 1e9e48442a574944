#include "io/gltf/buffers.hpp"

#include "io/file.hpp"
#include "io/gltf/extension.hpp"
#include "io/gltf/uri.hpp"
#include "io/json/excerpt.hpp"

#include <system_error>
#include <utility>

namespace microtrace::io::gltf {
namespace {

std::string decode(Asset& asset, const Element& uri) {
  const std::optional<DataUri> data = split_data_uri(uri.value->string);
  if (!data) asset.fail(uri, "is no data URI of the form data:TYPE;base64,DATA");
  if (data->media_type != "application/octet-stream" &&
      data->media_type != "application/gltf-buffer") {
    asset.warn(uri, "has a media type that is not for buffers; application/octet-stream is");
  }
  std::optional<std::string> bytes =
      data->is_base64 ? decode_base64(data->data) : decode_percent(data->data);
  if (!bytes && data->is_base64) {
    asset.fail(uri, "is not base64: groups of four of A-Z a-z 0-9 + /, padded with =");
  }
  if (!bytes) asset.fail(uri, "has a % without two hexadecimal digits; write %25 for %");
  return std::move(*bytes);
}

std::string read(const Asset& asset, const Element& uri, const std::filesystem::path& folder) {
  const RelativePath relative = relative_path(uri.value->string);
  if (!relative.refusal.empty()) {
    asset.fail(uri, in_quotes(uri.value->string) + " " + relative.refusal);
  }
  const std::filesystem::path path = folder / relative.path;
  std::error_code code;
  // A pipe or a device could keep its reader waiting for ever.
  if (!std::filesystem::is_regular_file(path, code)) {
    const bool missing = !std::filesystem::exists(path, code);
    asset.fail(uri,
               "buffer file " + in_quotes(path.string()) +
                   (missing ? " does not exist" : " is not a regular file"),
               // An asset that is not whole, rather than a machine that fails.
               missing ? ErrorKind::invalid_scene : ErrorKind::io);
  }
  try {
    return read_file(path, max_buffer_bytes);
  } catch (const Error& error) {
    asset.fail(uri, "buffer file " + in_quotes(path.string()) + " " + error.diagnostic().message,
               error.kind());
  }
}

/// Whether buffer 0 is the BIN chunk: a GLB file's first buffer without a URI.
bool is_bin(std::size_t index, const JsonValue& buffer) {
  return index == 0 && buffer.find("uri") == nullptr;
}

/// Whether the buffer's views have compressed bytes too, which are read instead.
bool is_fallback(const Element& buffer) {
  const auto compression = extension(buffer, "EXT_meshopt_compression");
  if (!compression) return false;
  const JsonValue* fallback = compression->value->find("fallback");
  return fallback != nullptr && fallback->boolean;
}

void check_total(const Asset& asset, const std::vector<JsonValue>& buffers) {
  double total = 0;
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    total += buffers[i].find("byteLength")->number;
    if (total > static_cast<double>(max_buffer_bytes)) {
      asset.fail(asset.element("buffers", i).member("byteLength"),
                 "brings the buffers to more than 4 GiB, the most that is read", ErrorKind::limit);
    }
  }
}

}  // namespace

std::vector<Buffer> load_buffers(Asset& asset, std::optional<std::string_view> bin,
                                 const std::filesystem::path& folder) {
  const std::vector<JsonValue>& buffers = asset.array("buffers");
  check_total(asset, buffers);
  if (bin && (buffers.empty() || !is_bin(0, buffers[0]))) {
    asset.warn(asset.root(), "the file's BIN chunk is no buffer's; it is ignored");
  }
  std::vector<Buffer> result(buffers.size());
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    Buffer& buffer = result[i];
    const Element at = asset.element("buffers", i);
    const Element uri = at.member("uri");
    if (bin && is_bin(i, buffers[i])) {
      buffer.bytes = *bin;
    } else if (is_fallback(at)) {
      continue;
    } else if (buffers[i].find("uri") != nullptr) {
      buffer.storage =
          is_data_uri(uri.value->string) ? decode(asset, uri) : read(asset, uri, folder);
      buffer.bytes = buffer.storage;
    } else {
      continue;
    }
    const auto length = static_cast<std::size_t>(at.member("byteLength").value->number);
    if (buffer.bytes->size() < length) {
      asset.fail(at.member("byteLength"), "claims " + std::to_string(length) +
                                              " bytes, but the buffer's data has only " +
                                              std::to_string(buffer.bytes->size()));
    }
    buffer.bytes = buffer.bytes->substr(0, length);
  }
  return result;
}

}  // namespace microtrace::io::gltf
