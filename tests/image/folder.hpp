#pragma once
/// Helpers for image tests: a temporary folder, functions that read and write files as bytes, and a
/// film to save.

#include <microtrace/film.hpp>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <stdlib.h>
#include <string>

namespace microtrace {

/// A new temporary folder. The destructor removes it with its content.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "microtrace-test-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const {
    return path_ / name;
  }

  [[nodiscard]] std::size_t entries() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(path_), {}));
  }

 private:
  std::filesystem::path path_;
};

inline std::string read_bytes(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

inline void write_bytes(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

/// Returns a film whose pixels are all different, with values below 0, between 0 and 1, and above
/// 1.
inline Film gradient(ImageSize size = {19, 7}) {
  Film film(size);
  for (std::uint32_t y = 0; y < size.height; ++y) {
    for (std::uint32_t x = 0; x < size.width; ++x) {
      const auto u = static_cast<float>(x) / static_cast<float>(size.width);
      const auto v = static_cast<float>(y) / static_cast<float>(size.height);
      film.at(x, y) = {1.25F * u - 0.125F, v, u * v};
    }
  }
  return film;
}

}  // namespace microtrace
