#include "io/gltf/bytes/resource.hpp"

#include "base/memory_account.hpp"
#include "base/system/error_text.hpp"
#include "base/text/printable.hpp"
#include "io/confined_reads.hpp"
#include "io/file.hpp"
#include "io/gltf/bytes/uri.hpp"

#include <system_error>
#include <utility>

namespace microtrace::io::gltf {
namespace {

/// The path of a file, and whether it may be read.
struct ResourcePath {
  RelativePath relative;
  std::filesystem::path path;
  bool is_allowed;
};

ResourcePath resource_path(const Element& uri, const ResourceFolders& folders) {
  RelativePath relative = relative_path(uri.value->string());
  std::filesystem::path path = folders.own / relative.path;
  const bool is_allowed =
      relative.refusal.empty() || (relative.leads_out && lies_within(folders.allowed, path));
  return {.relative = std::move(relative), .path = std::move(path), .is_allowed = is_allowed};
}

/// Returns why the file may not be read; nothing if it may.
std::optional<Refusal> refusal_of(const Element& uri, const ResourcePath& place) {
  if (place.is_allowed) return std::nullopt;
  return Refusal{.reason = in_quotes(uri.value->string()) + " " + place.relative.refusal +
                           (place.relative.leads_out ? ", or allow its folder (--allow-path)" : ""),
                 .is_violation = place.relative.is_invalid};
}

std::optional<std::string> decoded(const DataUri& data) {
  // RFC 2397 allows escaped characters in base64 too.
  const bool is_escaped = !data.is_base64 || data.data.find('%') != std::string_view::npos;
  if (!is_escaped) return decode_base64(data.data);
  std::optional<std::string> text = decode_percent(data.data);
  return data.is_base64 && text ? decode_base64(*text) : text;
}

}  // namespace

std::string decode_data_uri(const Asset& asset, const Element& uri) {
  const std::optional<DataUri> data = split_data_uri(uri.value->string());
  if (!data) asset.fail(uri, "is not a data URI of the form data:TYPE;base64,DATA");
  const std::size_t size = data->data.size();
  take_memory(data->is_base64 ? size / 4 * 3 : size, "the data of data URIs");
  std::optional<std::string> bytes = decoded(*data);
  if (!bytes && data->is_base64) {
    asset.fail(uri, "is not base64: A-Z a-z 0-9 + / in groups of four");
  }
  if (!bytes) asset.fail(uri, "has a % without two hexadecimal digits; write %25 for %");
  return std::move(*bytes);
}

std::string read_resource(const Asset& asset, const Element& uri, const ResourceFolders& folders,
                          const char* what, std::size_t max_bytes) {
  const ResourcePath place = resource_path(uri, folders);
  if (const auto refusal = refusal_of(uri, place)) asset.fail(uri, refusal->reason);
  const std::filesystem::path& path = place.path;
  const std::string file = std::string(what) + " file " + in_quotes(path.string());
  note_unread_file(path);  // it may be missing
  std::error_code code;
  // Reading a pipe or device could block forever.
  if (!std::filesystem::is_regular_file(path, code)) {
    if (std::filesystem::exists(path, code))
      asset.fail(uri, file + " is not a regular file", ErrorKind::io);
    // A missing file means that the asset is incomplete, not that the machine failed.
    if (!code) asset.fail(uri, file + " does not exist");
    asset.fail(uri, file + " can't be opened: " + error_text(code.value()), ErrorKind::io);
  }
  try {
    const ConfinedReads confined(folders.own, folders.allowed);
    return read_regular_file(path, max_bytes);
  } catch (const Error& error) {
    // Without a file, the error is about memory.
    const Diagnostic& problem = error.diagnostic();
    asset.fail(uri, problem.file.empty() ? problem.message : file + " " + problem.message, error);
  }
}

std::optional<Refusal> refusal_of(const Element& uri, const ResourceFolders& folders) {
  return refusal_of(uri, resource_path(uri, folders));
}

bool is_missing_resource(const Element& uri, const ResourceFolders& folders) {
  const ResourcePath place = resource_path(uri, folders);
  std::error_code code;
  return place.is_allowed && !std::filesystem::exists(place.path, code) && !code;
}

void tolerate_stray_percent(Asset& asset, const Element& uri) {
  const std::string& text = uri.value->string();
  if (!is_data_uri(text) && relative_path(text).has_stray_percent)
    asset.tolerate(uri, "has a % without two hexadecimal digits, which is read as it is");
}

void note_unread_resource(const Element& uri, const ResourceFolders& folders) {
  const RelativePath relative = relative_path(uri.value->string());
  if (relative.refusal.empty() || relative.leads_out) note_unread_file(folders.own / relative.path);
}

}  // namespace microtrace::io::gltf
