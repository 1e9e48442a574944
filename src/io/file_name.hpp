#pragma once
/// Examines names of files.

#include <algorithm>
#include <filesystem>
#include <string>

namespace microtrace::io {

/// Returns the name's extension, with its dot, in lower case. Empty if there is none.
[[nodiscard]] inline std::string lower_case_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return extension;
}

}  // namespace microtrace::io
