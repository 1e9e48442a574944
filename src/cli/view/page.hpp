#pragma once
/// The files of the page, which CMake compiles into the program (src/cli/view/page).

#include <span>
#include <string_view>

namespace microtrace::cli {

struct PageFile {
  std::string_view path;  ///< relative to the page; "" for the page itself
  std::string_view type;  ///< media type
  std::string_view content;
};

/// Defined in a source that CMake generates.
[[nodiscard]] std::span<const PageFile> page_files();

}  // namespace microtrace::cli
