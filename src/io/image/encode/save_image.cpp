#include "base/system/float_environment.hpp"
#include "base/text/printable.hpp"
#include "io/file_name.hpp"
#include "io/image/encode/png.hpp"
#include "io/image/encode/ppm.hpp"
#include "io/image/module.hpp"
#include "io/output/atomic_file.hpp"
#include "io/output/output_target.hpp"

#include <microtrace/error.hpp>
#include <microtrace/io.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <system_error>

namespace microtrace {
namespace {

/// Returns the name's extension in lower case without the dot. Returns "ppm" for standard output,
/// and for streams without an extension. Otherwise throws Error(usage) if there is no extension.
std::string format_extension(const std::filesystem::path& path) {
  if (path == "-") return "ppm";
  const std::string extension = io::lower_case_extension(path);
  if (extension.empty() && io::is_stream(path)) return "ppm";
  if (extension.size() < 2) {
    std::error_code ignored;
    throw Error(ErrorKind::usage, path.string(),
                std::filesystem::is_directory(path, ignored)
                    ? "is a folder; name a file in it"
                    : "has no extension that selects a picture format; use .ppm, .png or .exr");
  }
  return extension.substr(1);
}

void write_ppm(const Film& film, PpmEncoding encoding, io::AtomicFile& file) {
  constexpr std::size_t kBlock = std::size_t{1} << 16;
  std::string bytes = io::ppm_header(film.size(), encoding);
  for (std::uint32_t y = 0; y < film.size().height; ++y) {
    io::append_ppm_row(film, y, encoding, bytes);
    if (bytes.size() < kBlock) continue;
    file.write(bytes);
    bytes.clear();
  }
  file.write(bytes);
}

/// Throws Error(usage) unless the format can store everything in the film.
void require(const FilmContents& contents, const MicrotraceFormat& format,
             const std::filesystem::path& path, const std::string& extension) {
  const auto refuse = [&](const std::string& message) {
    throw Error(ErrorKind::usage, path == "-" ? "standard output" : path.string(),
                "." + extension + message);
  };
  if (contents.channels && format.has_channels == 0)
    refuse(" stores only colors; write further channels to an .exr file");
  if (contents.alpha && format.has_alpha == 0)
    refuse(" has no alpha; write .png or .exr, or give the background a color");
  if (!contents.size) return;
  const auto [width, height] = *contents.size;
  if (std::min(width, height) == 0) refuse(" needs at least 1 pixel");
  if (std::min(width, height) < format.least_side)
    refuse(" needs at least " + std::to_string(format.least_side) +
           " pixels in width and height; write .png");
  if (std::max(width, height) > format.most_side)
    refuse(" holds at most " + std::to_string(format.most_side) +
           " pixels in width and height; write .png");
}

/// Throws Error(usage) unless each channel has one number for each pixel and a name of its own.
void require_whole_channels(const Film& film) {
  const std::size_t pixels = std::size_t{film.size().width} * film.size().height;
  std::set<std::string> names = {"R", "G", "B", "A"};
  for (const Channel& channel : film.channels) {
    const auto refuse = [&](const char* message) {
      throw Error(ErrorKind::usage, "", "the channel " + in_quotes(channel.name) + message);
    };
    std::visit(
        [&](const auto& values) {
          if (values.size() != pixels) refuse(" must have one number for each pixel");
        },
        channel.values);
    if (!names.insert(channel.name).second) refuse(" has the name of another channel");
  }
}

/// Throws Error(usage) if the film has numbers that formats with one exponent for three colors
/// can't hold. Their writers would change them without a word.
void require_colors(const Film& film, const std::filesystem::path& path,
                    const std::string& extension) {
  for (std::uint32_t y = 0; y < film.size().height; ++y) {
    for (const Vec3& color : film.row(y)) {
      for (glm::length_t i = 0; i < 3; ++i) {
        if (color[i] >= 0 && std::isfinite(color[i])) continue;
        throw Error(ErrorKind::usage, path.string(),
                    "." + extension + " can't hold negative or infinite numbers; write .exr");
      }
    }
  }
}

/// The writer for files with a given extension. Loads its module if necessary. Formats that need no
/// library, such as PPM, are written here, and format_ states their capabilities.
class Writer {
 public:
  Writer(const std::filesystem::path& path, const std::string& extension) : extension_(extension) {
    if (extension == "ppm") return;
    if (extension == "png") {
      png_.emplace(path.string());
      format_.has_alpha = 1;
    } else {
      others_.emplace(path.string(), extension);
      format_ = others_->find_format(extension);
    }
  }

  [[nodiscard]] const MicrotraceFormat& format() const { return format_; }

  void write(const Film& film, PpmEncoding ppm, io::AtomicFile& file) const {
    const auto out = [&file](std::string_view bytes) { file.write(bytes); };
    if (png_) return png_->encode(film, out);
    if (others_) return others_->encode(film, extension_, out);
    write_ppm(film, ppm, file);
  }

 private:
  std::string extension_;
  std::optional<io::PngEncoder> png_;
  std::optional<io::ImageModule> others_;
  // Initially PPM's: 8 bits, no alpha, no channels, any size.
  MicrotraceFormat format_{.is_float = 0,
                           .has_alpha = 0,
                           .has_channels = 0,
                           .least_side = 1,
                           .most_side = kMicrotraceAnySide};
};

}  // namespace

void check_image_path(const std::filesystem::path& path, const FilmContents& contents) {
  const std::string extension = format_extension(path);
  require(contents, Writer(path, extension).format(), path, extension);
  io::check_target(path);
}

void check_sidecar_path(const std::filesystem::path& path, const std::filesystem::path& picture) {
  std::error_code ignored;
  if (path == picture || std::filesystem::equivalent(path, picture, ignored)) {
    throw Error(ErrorKind::usage, path.string(),
                "is also the picture's file; name another file for the sidecar");
  }
  io::check_target(path);
}

void save_image(const Film& film, const std::filesystem::path& path, PpmEncoding ppm,
                const Sidecar* sidecar) {
  const FloatEnvironment environment;
  require_whole_channels(film);
  const std::string extension = format_extension(path);
  const FilmContents contents{
      .alpha = film.has_alpha(), .channels = !film.channels.empty(), .size = film.size()};
  const Writer writer(path, extension);
  require(contents, writer.format(), path, extension);
  if (writer.format().is_float != 0 && writer.format().has_channels == 0)
    require_colors(film, path, extension);
  std::optional<io::AtomicFile> beside;
  if (sidecar != nullptr) {
    beside.emplace(sidecar->path);
    beside->write(sidecar->text);
    beside->close();
  }
  io::AtomicFile file(path);
  writer.write(film, ppm, file);
  file.commit();
  if (beside) beside->commit();
}

}  // namespace microtrace
