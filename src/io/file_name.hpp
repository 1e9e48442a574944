#pragma once
/// Examines names of files, and adds them to errors.

#include <microtrace/error.hpp>

#include <algorithm>
#include <filesystem>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>

namespace microtrace::io {

/// Returns the name's extension, with its dot, in lower case. Empty if there is none.
[[nodiscard]] inline std::string lower_case_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return extension;
}

/// Runs one step of loading a scene and converts all exceptions to Error. Adds the name of the
/// scene's file to errors that name no file, such as those of the memory budget.
template <typename Step>
auto naming_file(const std::string& name, Step&& step) {
  try {
    return std::forward<Step>(step)();
  } catch (const Error& error) {
    if (!error.diagnostic().file.empty()) throw;
    throw Error(error.kind(), name, error.diagnostic().message);
  } catch (const std::bad_alloc&) {
    throw Error(ErrorKind::limit, name, "the scene needs more memory than is available");
  } catch (const std::exception& error) {
    throw Error(ErrorKind::internal, name,
                std::string("reading the scene failed: ") + error.what());
  }
}

}  // namespace microtrace::io
