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

/// The only format that stores channels beside colors.
constexpr char kChannelFormat[] = "exr";

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
  const bool has_channels = extension == kChannelFormat;
  const bool is_deviation = shows_variance(job) && !has_channels;
  const bool needs_channels = !job.arguments.aovs.empty() && !is_deviation;
  if (needs_channels && !has_channels) {
    refuse_usage("." + extension + " stores only colors, without the channels of --aov; choose " +
                 kChannelFormat);
  }
  const TemporaryFolder folder;
  const fs::path path = folder.path() / ("picture." + extension);
  check_image_path(path,
                   {.alpha = job.options.transparent && !is_deviation, .channels = needs_channels});
  const Film film = render(job);
  save_image(is_deviation ? deviation_picture(film) : film, path);
  return {.type = extension == "png" ? "image/png" : "application/octet-stream",
          .body = io::read_file(path, io::kMaxFileSize),
          .file = file_name(scene, extension)};
}

}  // namespace microtrace::cli
