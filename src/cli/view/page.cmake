# Generates the source that defines page_files(), from the files in page/.
set(entries)
foreach(entry "|text/html|index.html" "style.css|text/css|style.css" "app.js|text/javascript|app.js"
              "camera.js|text/javascript|camera.js" "options.js|text/javascript|options.js"
              "pixel.js|text/javascript|pixel.js" "server.js|text/javascript|server.js"
              "compare.js|text/javascript|compare.js" "page.js|text/javascript|page.js"
              "side.js|text/javascript|side.js" "controls.js|text/javascript|controls.js"
              "keep.js|text/javascript|keep.js")
  string(REPLACE "|" ";" parts "${entry}")
  list(GET parts 0 path)
  list(GET parts 1 type)
  list(GET parts 2 file)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/page/${file})
  file(READ ${CMAKE_CURRENT_LIST_DIR}/page/${file} content)
  string(APPEND entries "    {\"${path}\", \"${type}; charset=utf-8\", R\"page(${content})page\"},\n")
endforeach()
file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/page_files.cpp @ONLY CONTENT [=[
#include "cli/view/page.hpp"

namespace microtrace::cli {

std::span<const PageFile> page_files() {
  static constexpr PageFile files[]{
@entries@  };
  return files;
}

}  // namespace microtrace::cli
]=])
