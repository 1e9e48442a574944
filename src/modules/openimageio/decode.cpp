/// Decodes images with OpenImageIO, behind the C interface of io/image/module_abi.hpp. Reads from
/// memory, because only the library accesses files.

#include "io/image/module_abi.hpp"
#include "modules/openimageio/tiff_tags.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <exception>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

namespace {

using OIIO::ImageInput;
using OIIO::ImageSpec;
using OIIO::TypeDesc;

/// Makes an exception from the first of OpenImageIO's messages, which are separated by line breaks.
/// OpenImageIO prints messages that nobody fetched at exit.
std::runtime_error complaint(const std::string& otherwise) {
  std::string message = OIIO::geterror();
  if (message.empty()) message = otherwise;
  message.resize(std::min(message.find('\n'), message.size()));
  return std::runtime_error(message.empty() ? "it is damaged" : message);
}

/// Returns the index of the first of the channels red, green and blue, or of the gray channel.
int first_color(const ImageSpec& spec) {
  for (int i = 0; i + 2 < spec.nchannels; ++i) {
    if (spec.channel_name(i) == "R" && spec.channel_name(i + 1) == "G" &&
        spec.channel_name(i + 2) == "B")
      return i;
  }
  return 0;
}

/// Returns the format of returned samples. 8-bit and 16-bit integers are returned unchanged,
/// floating-point numbers as float32. Half floats convert to float32 exactly.
MicrotraceNumber number_of(const ImageSpec& spec) {
  if (spec.format == TypeDesc::UINT8) return kMicrotraceU8;
  if (spec.format == TypeDesc::UINT16) return kMicrotraceU16;
  if (spec.format.is_floating_point()) return kMicrotraceF32;
  throw std::runtime_error("its samples are neither floating-point nor of 8 or 16 bits");
}

TypeDesc type_of(MicrotraceNumber number) {
  if (number == kMicrotraceU8) return TypeDesc::UINT8;
  return number == kMicrotraceU16 ? TypeDesc::UINT16 : TypeDesc::FLOAT;
}

/// Returns the orientation of a Radiance file by its resolution line, such as "-Y 512 +X 1024": the
/// axis of the lines comes first. OpenImageIO confuses 6 and 8.
int orientation_of_hdr(std::string_view file) {
  const std::size_t end = file.find("\n\n");
  const std::string_view line = file.substr(std::min(end, file.size() - 2) + 2);
  const std::size_t second = line.find_first_of("+-", 1);
  if (end == file.npos || second == line.npos || line.size() < 2) return 1;
  const std::string axes{line[0], line[1], line[second], line[second + 1]};
  constexpr std::array kAxes = {"-Y+X", "-Y-X", "+Y-X", "+Y+X", "+X-Y", "-X-Y", "-X+Y", "+X+Y"};
  const auto found = std::ranges::find(kAxes, axes);
  return found == kAxes.end() ? 1 : static_cast<int>(found - kAxes.begin()) + 1;
}

/// Where the pixels of a file are in the upright picture, by the orientations 1 to 8 of TIFF 6.0,
/// page 36, which EXIF has too.
class Orientation {
 public:
  Orientation(const ImageSpec& spec, int number)
      : number_(number),
        width_(static_cast<std::size_t>(spec.width)),
        height_(static_cast<std::size_t>(spec.height)) {}

  [[nodiscard]] bool is_upright() const { return number_ < 2 || number_ > 8; }
  [[nodiscard]] bool is_transposed() const { return number_ > 4 && number_ <= 8; }

  /// Copies pixels of `size` bytes.
  void turn(const char* stored, char* upright, std::size_t size) const {
    const bool ends_right = number_ == 2 || number_ == 3 || number_ == 7 || number_ == 8;
    const bool ends_below = number_ == 3 || number_ == 4 || number_ == 6 || number_ == 7;
    const std::size_t width = is_transposed() ? height_ : width_;
    const std::size_t height = is_transposed() ? width_ : height_;
    for (std::size_t y = 0; y < height; ++y) {
      for (std::size_t x = 0; x < width; ++x) {
        const std::size_t column = is_transposed() ? y : x, row = is_transposed() ? x : y;
        const std::size_t from = (ends_below ? height_ - 1 - row : row) * width_ +
                                 (ends_right ? width_ - 1 - column : column);
        std::memcpy(upright + (y * width + x) * size, stored + from * size, size);
      }
    }
  }

 private:
  int number_;
  std::size_t width_, height_;
};

/// Throws for kinds of TIFF files that OpenImageIO 2.4 misreads without an error.
void require_readable_tiff(std::string_view file) {
  constexpr std::uint32_t kBitsPerSample = 258, kCompression = 259, kPhotometric = 262;
  const std::optional<std::uint32_t> bits = short_of_tiff(file, kBitsPerSample);
  if (!bits && short_of_tiff(file, kCompression).value_or(1) == 1)
    throw std::runtime_error("it is a TIFF file of 1 bit per sample");
  if (bits == 16U && short_of_tiff(file, kPhotometric) == 0U)
    throw std::runtime_error("it is a TIFF file of 16 bits in which white is 0");
}

/// A file in memory and its reader.
class MemoryFile {
 public:
  MemoryFile(const void* bytes, std::size_t size, const std::string& extension)
      : memory_(const_cast<void*>(bytes), size) {  // which is never written to
    ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);  // returns colors as stored in the file
    reader_ = ImageInput::create(extension, false, &config, &memory_);
    if (!reader_ || !reader_->supports("ioproxy") ||
        std::string(reader_->format_name()) == "null") {
      static_cast<void>(OIIO::geterror());
      throw std::runtime_error("OpenImageIO can't read files with this extension");
    }
    reader_->set_ioproxy(&memory_);
    if (!reader_->open("picture." + extension, spec_, config)) throw complaint(reader_->geterror());
  }

  [[nodiscard]] ImageInput& reader() { return *reader_; }
  [[nodiscard]] const ImageSpec& spec() const { return spec_; }

 private:
  OIIO::Filesystem::IOMemReader memory_;
  std::unique_ptr<ImageInput> reader_;
  ImageSpec spec_;
};

/// Returns true if a GIF file has several frames, or a TIFF file several pages. Smaller copies of a
/// page don't count (NewSubfileType, TIFF 6.0, page 36). Opens the file again, because the reader
/// of GIF can't return to the first frame.
bool has_further_pictures(const void* bytes, std::size_t size, const std::string& extension) {
  MemoryFile file(bytes, size, extension);
  ImageInput& reader = file.reader();
  bool result = false;
  for (int i = 1; !result && reader.seek_subimage(i, 0); ++i)
    result = (reader.spec().get_int_attribute("tiff:subfiletype", 0) & 1) == 0;
  static_cast<void>(reader.geterror());  // that there are no more
  return result;
}

void decode(const void* bytes, std::size_t size, const std::string& extension,
            const MicrotraceColorSink& sink) {
  OIIO::attribute("threads", 1);
  OIIO::attribute("exr_threads", -1);  // uses only the calling thread
  MemoryFile input(bytes, size, extension);
  ImageInput& reader = input.reader();
  const ImageSpec& spec = input.spec();
  if (spec.deep || spec.depth != 1 || spec.width < 1 || spec.height < 1 || spec.nchannels < 1)
    throw std::runtime_error("it is no plain picture of two dimensions");
  const int first = first_color(spec);
  const int colors_count = spec.nchannels - first < 3 ? 1 : 3;
  const int alpha = first + colors_count;
  // OpenImageIO 2.4 sets no alpha_channel for GIF and for gray TGA files of version 1.
  const bool has_alpha =
      alpha < spec.nchannels &&
      (spec.alpha_channel == alpha || spec.channel_name(alpha) == "A" || spec.nchannels == 2);
  const int count = colors_count + (has_alpha ? 1 : 0);
  const std::string_view format = reader.format_name();
  const std::string_view file(static_cast<const char*>(bytes), size);
  if (format == "tiff") require_readable_tiff(file);
  const bool has_further =
      (format == "gif" || format == "tiff") && has_further_pictures(bytes, size, extension);
  const Orientation orientation(
      spec, format == "hdr" ? orientation_of_hdr(file) : spec.get_int_attribute("Orientation", 1));
  auto width = static_cast<std::uint32_t>(spec.width);
  auto height = static_cast<std::uint32_t>(spec.height);
  if (orientation.is_transposed()) std::swap(width, height);
  const MicrotraceColors colors{
      .width = width,
      .height = height,
      .channels = static_cast<std::uint32_t>(count),
      .number = number_of(spec),
      .is_unassociated = spec.get_int_attribute("oiio:UnassociatedAlpha", 0),
      .has_further = has_further ? 1 : 0,
      .x0 = 0,
      .y0 = 0,
      .whole_width = width,
      .whole_height = height};
  void* samples = sink.begin(sink.context, &colors);
  if (samples == nullptr) throw std::runtime_error("it is too large");
  const TypeDesc type = type_of(colors.number);
  const std::size_t pixel = type.size() * colors.channels;
  std::vector<char> stored(orientation.is_upright() ? 0 : pixel * width * height);
  const bool is_read =
      reader.read_image(0, 0, first, first + count, type, stored.empty() ? samples : stored.data());
  // For TIFF files that were cut off, only the error tells of the missing lines.
  const std::string error = reader.geterror();
  if (!is_read || !error.empty()) throw complaint(error);
  if (!stored.empty()) orientation.turn(stored.data(), static_cast<char*>(samples), pixel);
  reader.close();
}

}  // namespace

extern "C" {

__attribute__((visibility("default"))) int microtrace_decode_colors_v4(
    const void* bytes, std::size_t size, const char* extension, const MicrotraceColorSink* sink) {
  try {
    decode(bytes, size, extension, *sink);
    return 1;
  } catch (const std::exception& e) {
    sink->complain(sink->context, e.what());
    return 0;
  }
}
}
