#include "cli/report/written_files.hpp"

#include "base/counted.hpp"
#include "base/text/printable.hpp"
#include "cli/options/option_value.hpp"
#include "cli/report/progress_bar.hpp"

#include <cstdio>
#include <string>

namespace microtrace::cli {

void report_written(const WrittenFiles& files, ImageSize size, std::uint32_t samples,
                    const Display& display, double seconds) {
  std::string names;
  for (const std::filesystem::path& file : {files.main, files.sidecar}) {
    if (file.empty() || file == "-") continue;
    names.append(names.empty() ? "" : " and ").append(printable(file.string()));
  }
  if (names.empty()) return;
  std::string exposure;
  if (display.srgb && display.exposure != 0)
    exposure = " exposure " + shortest(display.exposure) + ",";
  clear_progress_bar();
  std::fprintf(stderr, "wrote %s: %u x %u pixels, %s each,%s in %.*f s\n", names.c_str(),
               size.width, size.height, counted(samples, "sample").c_str(), exposure.c_str(),
               seconds < 1 ? 3 : 1, seconds);
}

}  // namespace microtrace::cli
