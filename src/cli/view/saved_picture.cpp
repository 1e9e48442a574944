#include "cli/view/saved_picture.hpp"

#include "cli/options/option_value.hpp"
#include "cli/temporary_folder.hpp"
#include "io/file.hpp"

#include <microtrace/error.hpp>
#include <microtrace/io.hpp>

#include <algorithm>
#include <filesystem>

namespace microtrace::cli {
namespace {

namespace fs = std::filesystem;

/// The scene's name, without characters that have a meaning in header fields.
std::string file_name(const std::string& scene, const std::string& extension) {
  std::string stem = fs::path(scene).stem().string();
  std::ranges::replace_if(
      stem, [](char c) { return c < ' ' || c > '~' || c == '"' || c == '\\' || c == '/'; }, '_');
  return (stem.empty() ? "picture" : stem) + "." + extension;
}

}  // namespace

io::HttpResponse saved_picture(const PictureJob& job, const std::string& scene,
                               const std::string& extension) {
  const bool is_plain = !extension.empty() && extension.size() <= 5 &&
                        std::ranges::all_of(extension, [](char c) { return c >= 'a' && c <= 'z'; });
  if (!is_plain) refuse_usage("format: must be the extension of a picture's file, such as png");
  const TemporaryFolder folder;
  const fs::path path = folder.path() / ("picture." + extension);
  check_image_path(path,
                   {.alpha = job.options.transparent, .channels = !job.arguments.aovs.empty()});
  save_image(render(job), path);
  return {.type = extension == "png" ? "image/png" : "application/octet-stream",
          .body = io::read_file(path, io::kMaxFileSize),
          .file = file_name(scene, extension)};
}

}  // namespace microtrace::cli
