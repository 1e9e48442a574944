#include "base/system/error_text.hpp"
#include "base/text/printable.hpp"
#include "dataset/dataset_json.hpp"
#include "dataset/links.hpp"
#include "dataset/manifest_reader.hpp"
#include "dataset/measure.hpp"
#include "io/file.hpp"
#include "io/output/atomic_file.hpp"

#include <microtrace/dataset.hpp>

#include <algorithm>
#include <charconv>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace microtrace {
namespace {

namespace fs = std::filesystem;
using io::JsonReader;

constexpr std::size_t kMaxRecord = std::size_t{64} << 20U;  ///< bytes of a JSON file of ours

DatasetIdentity read_identity(const fs::path& path) {
  return read_own(io::read_regular_file(path, kMaxRecord), path, identity_of);
}

std::vector<std::string_view> words_of(std::string_view text) {
  std::vector<std::string_view> words;
  while (!text.empty()) {
    words.push_back(text.substr(0, text.find(' ')));
    text.remove_prefix(std::min(words.back().size() + 1, text.size()));
  }
  return words;
}

/// Returns what two lists of options have between their common words at the beginning and at the
/// end: "--spp=3 instead of --spp=4".
std::string differing_options(std::string_view a, std::string_view b) {
  std::vector<std::string_view> ours = words_of(a), theirs = words_of(b);
  const auto drop_common = [&] {
    const auto ends = std::ranges::mismatch(ours, theirs);
    ours.erase(ours.begin(), ends.in1);
    theirs.erase(theirs.begin(), ends.in2);
    std::ranges::reverse(ours);
    std::ranges::reverse(theirs);
  };
  drop_common();
  drop_common();
  const auto joined = [](std::span<const std::string_view> words) {
    std::string text;
    for (const std::string_view word : words)
      text.append(text.empty() ? "" : " ").append(printable(word));
    return text.empty() ? "the default" : text;
  };
  return joined(ours) + " instead of " + joined(theirs);
}

/// Returns the first difference between two data sets.
std::optional<std::string> difference(const DatasetIdentity& a, const DatasetIdentity& b) {
  if (a.program != b.program) return "another version, " + a.program + " instead of " + b.program;
  if (a.scene != b.scene) return "another scene, " + a.scene + " instead of " + b.scene;
  if (a.options != b.options) return "other options, " + differing_options(a.options, b.options);
  if (a.digest != b.digest)
    return "another content of the scene's or the views' files, or other decoders";
  if (a.views != b.views)
    return "another number of views, " + std::to_string(a.views) + " instead of " +
           std::to_string(b.views);
  return std::nullopt;
}

[[noreturn]] void fail(const fs::path& path, const std::error_code& error) {
  throw Error(ErrorKind::io, path.string(), "can't be created: " + error_text(error.value()),
              error.value());
}

void create_folder(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error) fail(path, error);
}

void write_file(const fs::path& path, std::string_view text) {
  io::AtomicFile file(path);
  file.write(text);
  file.commit();
}

/// Writes the identity unless there is one. Returns false if there is.
bool write_identity(const fs::path& path, const DatasetIdentity& identity) {
  const std::string text = text_of(identity);
  try {
    const io::JsonDocument readable(text, path.string());
  } catch (const Error&) {
    throw Error(ErrorKind::usage, path.string(),
                "can't contain names that are not UTF-8, such as that of the scene, of the current "
                "folder or in an option; rename them");
  }
  io::AtomicFile file(path);
  file.write(text);
  file.sync();
  return file.commit_new();
}

DatasetFile existing(const fs::path& folder, const std::string& name) {
  const std::optional<DatasetFile> file = measure(folder, name);
  if (!file) throw Error(ErrorKind::io, (folder / name).string(), "has disappeared");
  return *file;
}

/// Returns true if the folder contains nothing but what another process that starts the same data
/// set may have written so far.
bool is_unused(const fs::path& folder) {
  std::error_code error;
  return std::ranges::all_of(fs::directory_iterator(folder, error), [](const auto& entry) {
    const std::string name = entry.path().filename().string();
    return name.starts_with(".microtrace-") || name == "records" || name == "dataset.json";
  });
}

}  // namespace

DatasetFolder::DatasetFolder(fs::path path, const DatasetIdentity& identity)
    : path_(std::move(path)), identity_(identity) {
  create_folder(path_);
  const fs::path file = path_ / "dataset.json";
  const auto is_data_set = [&] {
    std::error_code error;
    return fs::exists(file, error);
  };
  // Another process may start a data set in the same folder at the same time, and may have written
  // its first view since the first look.
  if (!is_data_set() && !is_unused(path_) && !is_data_set()) {
    throw Error(ErrorKind::usage, path_.string(),
                "contains files that are not a data set; name another folder");
  }
  if (is_data_set() || !write_identity(file, identity)) {
    if (const auto reason = difference(read_identity(file), identity)) {
      throw Error(ErrorKind::usage, path_.string(),
                  "contains a data set of " + *reason + "; name another folder");
    }
  }
  create_folder(path_ / "records");
  refuse_links(path_);
}

DatasetFolder::DatasetFolder(fs::path path) : path_(std::move(path)) {
  const fs::path file = path_ / "dataset.json";
  std::error_code error;
  if (fs::is_directory(path_, error) && !fs::exists(file, error))
    throw Error(ErrorKind::io, path_.string(), "is not a data set: it has no dataset.json");
  identity_ = read_identity(file);
}

fs::path DatasetFolder::record(std::uint32_t view) const {
  return path_ / dataset_file_name("records/{view:06d}.json", "", view, "");
}

std::optional<std::vector<DatasetFile>> DatasetFolder::files(std::uint32_t view) const {
  const fs::path path = record(view);
  std::error_code error;
  if (!fs::exists(path, error)) return std::nullopt;
  const std::string text = io::read_regular_file(path, kMaxRecord);
  // A power failure can leave a record without its content, and people may exchange records.
  try {
    return read_own(text, path, [view](const JsonReader& root) {
      root.require_object({"view", "files"});
      if (root.member("view").count() != view) root.member("view").fail("is another view's");
      std::vector<DatasetFile> files;
      for (const JsonReader& item : root.member("files").items())
        files.push_back(read_file_entry(item));
      return files;
    });
  } catch (const Error& failure) {
    if (failure.kind() != ErrorKind::io) throw;
    return std::nullopt;
  }
}

/// Returns files(view). Throws Error (io) if the record is missing or damaged.
std::vector<DatasetFile> DatasetFolder::recorded(std::uint32_t view) const {
  auto known = files(view);
  if (!known)
    throw Error(ErrorKind::io, record(view).string(), "is damaged; run the same command again");
  return std::move(*known);
}

std::uint64_t DatasetFolder::check_manifest() const {
  const auto fail_at = [](const fs::path& file, const std::string& problem) {
    throw Error(ErrorKind::io, file.string(), problem + "; continue with microtrace dataset");
  };
  const fs::path path = path_ / kManifest;
  std::error_code error;
  if (!fs::exists(path, error)) fail_at(path, "is missing");
  ManifestReader manifest(path_);
  std::uint64_t count = 1;
  for (std::uint32_t view = 0; view < identity_.views; ++view) {
    for (const DatasetFile& file : recorded(view)) {
      if (manifest.next() != file) fail_at(path, "differs from the records");
      ++count;
    }
  }
  while (const std::optional<DatasetFile> file = manifest.next()) {
    if (measure(path_, file->name) != file)
      fail_at(path_ / file->name, "is missing or was changed");
    ++count;
  }
  return count;
}

bool DatasetFolder::is_finished() const try {
  static_cast<void>(check_manifest());
  return true;
} catch (const Error& error) {
  if (error.kind() != ErrorKind::io) throw;
  return false;
}

bool DatasetFolder::is_whole(std::uint32_t view) const {
  const auto known = files(view);
  return known && !first_damaged(path_, *known);
}

void DatasetFolder::finish(std::uint32_t view, const std::vector<std::string>& names) {
  std::string text = "{\"view\": " + std::to_string(view) + ", \"files\": [";
  for (const std::string& name : names) {
    if (text.back() != '[') text += ",\n ";
    append_file(text, existing(path_, name));
  }
  write_file(record(view), text += "]}\n");
}

std::vector<std::uint32_t> DatasetFolder::damaged(
    const std::function<bool(const std::string& name)>& is_read) const {
  const auto is_whole = [&](const DatasetFile& file) {
    return has_size(path_, file) && (!is_read(file.name) || measure(path_, file.name) == file);
  };
  std::vector<std::uint32_t> views;
  for (std::uint32_t view = 0; view < identity_.views; ++view) {
    const auto known = files(view);
    if (!known || !std::ranges::all_of(*known, is_whole)) views.push_back(view);
  }
  return views;
}

std::uint32_t DatasetFolder::missing() const {
  // One list of the folder is faster than a question for each record, above all over a network.
  std::vector<bool> is_finished(identity_.views);
  std::error_code error;
  fs::directory_iterator entry(path_ / "records", error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    std::uint32_t view = 0;
    std::from_chars(name.data(), name.data() + name.size(), view);
    if (view < identity_.views && entry->path() == record(view)) is_finished[view] = true;
  }
  if (error) {
    throw Error(ErrorKind::io, (path_ / "records").string(),
                "can't be listed: " + error_text(error.value()), error.value());
  }
  return static_cast<std::uint32_t>(std::ranges::count(is_finished, false));
}

void DatasetFolder::write_manifest(std::span<const std::string> more) const {
  io::AtomicFile out(path_ / kManifest);
  std::string_view separator = "[\n";
  const auto add = [&](const DatasetFile& file) {
    std::string text(separator);
    append_file(text, file);
    out.write(text);
    separator = ",\n";
  };
  for (std::uint32_t view = 0; view < identity_.views; ++view) {
    for (const DatasetFile& file : recorded(view)) add(file);
  }
  for (const std::string& name : more) add(existing(path_, name));
  out.write("\n]\n");
  out.commit();
}

void write_dataset_file(const fs::path& path, std::string_view bytes) {
  create_folder(path.parent_path());
  write_file(path, bytes);
}

}  // namespace microtrace
