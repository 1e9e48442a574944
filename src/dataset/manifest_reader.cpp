#include "dataset/manifest_reader.hpp"

#include "dataset/dataset_json.hpp"

#include <microtrace/error.hpp>

#include <string>
#include <system_error>

namespace microtrace {

ManifestReader::ManifestReader(const std::filesystem::path& folder) : path_(folder / kManifest) {
  std::error_code error;
  const bool exists = std::filesystem::exists(path_, error);
  if (exists && !std::filesystem::is_regular_file(path_, error))
    throw Error(ErrorKind::io, path_.string(), "is not a regular file");
  lines_.open(path_, std::ios::binary);
  if (exists && !lines_) throw Error(ErrorKind::io, path_.string(), "can't be read");
}

std::optional<DatasetFile> ManifestReader::next() {
  for (std::string line; std::getline(lines_, line);) {
    is_ended_ = line == "]";
    if (line == "[" || is_ended_ || line.empty()) continue;
    if (line.back() == ',') line.pop_back();
    return read_own(line, path_, read_file_entry);
  }
  if (lines_.is_open() && !lines_.eof())
    throw Error(ErrorKind::io, path_.string(), "can't be read");
  if (lines_.is_open() && !is_ended_)
    throw Error(ErrorKind::io, path_.string(), "is cut off; continue with microtrace dataset");
  return std::nullopt;
}

}  // namespace microtrace
