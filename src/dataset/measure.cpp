#include "dataset/measure.hpp"

#include <microtrace/digest.hpp>
#include <microtrace/error.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <memory>
#include <system_error>

namespace microtrace {

namespace fs = std::filesystem;

bool has_size(const fs::path& folder, const DatasetFile& file) {
  std::error_code error;
  return fs::file_size(folder / file.name, error) == file.size && !error;
}

std::optional<DatasetFile> measure(const fs::path& folder, const std::string& name) {
  std::error_code error;
  const fs::path path = folder / name;
  if (!fs::is_regular_file(path, error)) return std::nullopt;
  std::ifstream file(path, std::ios::binary);
  constexpr std::size_t kPart = std::size_t{1} << 18U;
  const auto part = std::make_unique_for_overwrite<char[]>(kPart);
  Digest digest;
  std::uint64_t size = 0;
  while (file.read(part.get(), kPart), file.gcount() > 0) {
    const auto count = static_cast<std::size_t>(file.gcount());
    digest.add({part.get(), count});
    size += count;
  }
  if (!file.eof()) throw Error(ErrorKind::io, path.string(), "can't be read");
  return DatasetFile{.name = name, .size = size, .digest = digest.value()};
}

std::optional<std::string> first_damaged(const fs::path& folder,
                                         std::span<const DatasetFile> files) {
  const auto differs = [&](const DatasetFile& file) { return measure(folder, file.name) != file; };
  const auto found = std::ranges::find_if(files, differs);
  if (found == files.end()) return std::nullopt;
  return found->name;
}

}  // namespace microtrace
