/// Encodes images with OpenImageIO, behind the C interface of io/image/module_abi.hpp. Writes to
/// memory, because only the library accesses files and reports failures.

#include "io/image/module_abi.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <memory>
#include <new>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

namespace {

using OIIO::ImageOutput;
using OIIO::ImageSpec;
using OIIO::TypeDesc;

/// Returns the writer for an extension, or null if there is none that can write to memory.
std::unique_ptr<ImageOutput> find_writer(const std::string& extension) {
  OIIO::attribute("threads", 1);
  OIIO::attribute("exr_threads", -1);  // uses only the calling thread
  std::unique_ptr<ImageOutput> writer = ImageOutput::create(extension);
  if (!writer) {
    // Fetches the error message, which OpenImageIO would otherwise print at exit.
    static_cast<void>(OIIO::geterror());
    return nullptr;
  }
  const std::string_view format = writer->format_name();
  // The writer for PNM stores three colors under any extension, also for gray and floating-point
  // pictures.
  const bool is_other_pnm = format == "pnm" && extension != "pnm";
  if (!writer->supports("ioproxy") || format == "null" || is_other_pnm) return nullptr;
  return writer;
}

/// Returns true for the format that stores linear light. OpenEXR has its own module.
bool is_float_format(std::string_view name) {
  return name == "hdr";
}

/// Returns true for formats that preserve alpha exactly. GIF's alpha has only one bit, writers of
/// other formats change the colors, and few programs find the alpha that OpenImageIO writes to BMP.
bool holds_alpha(std::string_view name) {
  constexpr std::array kNames = {"png", "tiff", "targa", "webp"};
  return std::ranges::find(kNames, name) != kNames.end();
}

struct Sides {
  std::uint32_t least = 1, most = kMicrotraceAnySide;
};

/// The limits of width and height. Beyond them, libjpeg ends the process, JPEG 2000 files are
/// damaged, and other encoders fail after the rendering.
Sides sides_of(std::string_view name) {
  if (name == "jpeg") return {.most = 65500};
  if (name == "webp") return {.most = 16383};
  if (name == "targa" || name == "gif") return {.most = 65535};
  if (name == "jpeg2000") return {.least = 32};
  return {};
}

TypeDesc type_of(MicrotraceNumber number) {
  return number == kMicrotraceU8 ? TypeDesc::UINT8 : TypeDesc::FLOAT;
}

ImageSpec describe(const MicrotracePicture& picture, std::span<const MicrotraceChannel> channels,
                   const ImageOutput& writer) {
  const std::string_view format = writer.format_name();
  ImageSpec spec(static_cast<int>(picture.width), static_cast<int>(picture.height),
                 static_cast<int>(channels.size()), type_of(channels[0].number));
  spec.channelnames.clear();
  for (const MicrotraceChannel& channel : channels) spec.channelnames.emplace_back(channel.name);
  if (channels.size() > 3 && std::string_view(channels[3].name) == "A") {
    spec.alpha_channel = 3;
    spec.attribute("oiio:UnassociatedAlpha", 1);
  }
  if (writer.supports("displaywindow")) {
    spec.x = static_cast<int>(picture.x0);
    spec.y = static_cast<int>(picture.y0);
    spec.full_width = static_cast<int>(picture.whole_width);
    spec.full_height = static_cast<int>(picture.whole_height);
  }
  // Omitted for TIFF, whose writer would store the color space in a second directory. OpenImageIO
  // can't link this directory when it writes to memory.
  if (format != "tiff" && picture.is_color != 0)
    spec.attribute("oiio:ColorSpace", is_float_format(format) ? "Linear" : "sRGB");
  for (const MicrotraceNote& note : std::span(picture.notes, picture.note_count)) {
    spec.attribute(note.name, note.text);
  }
  // The empty value keeps writers from storing the current time, which would make equal pictures
  // differ.
  spec.attribute("DateTime", "");
  return spec;
}

/// Rounds the colors of a picture to the nearest that HDR can store: mantissas of 8 bits with a
/// common exponent (Ward 1991). The writer would truncate them, and store large ones as black.
std::vector<float> rounded_for_hdr(const MicrotracePicture& picture, std::size_t channels) {
  const std::size_t pixels = std::size_t{picture.width} * picture.height;
  const auto* from = static_cast<const float*>(picture.channels[0].first);
  std::vector<float> colors(from, from + pixels * channels);
  const float most = std::ldexp(255.0F, 127 - 8);
  for (std::size_t i = 0; i < colors.size(); i += channels) {
    const std::span color(colors.data() + i, channels);
    for (float& value : color) value = std::min(value, most);
    int exponent = 0;
    const float mantissa = std::frexp(*std::ranges::max_element(color), &exponent);
    if (mantissa * 256 >= 255.5F) ++exponent;
    for (float& value : color)
      value = std::ldexp(std::round(std::ldexp(value, 8 - exponent)), exponent - 8);
  }
  return colors;
}

/// Returns the bytes of the file. Throws std::runtime_error with the reason on failure.
std::vector<unsigned char> encode(const MicrotracePicture& picture, const std::string& extension) {
  const std::unique_ptr<ImageOutput> writer = find_writer(extension);
  if (!writer) throw std::runtime_error("OpenImageIO has no such writer");
  const std::span channels(picture.channels, picture.channel_count);
  const ImageSpec spec = describe(picture, channels, *writer);
  OIIO::Filesystem::IOVecOutput memory;
  writer->set_ioproxy(&memory);
  std::string name = "picture.";
  name += extension;
  bool written = writer->open(name, spec);
  if (written) {
    // The picture has only color channels, whose layout in memory equals the file's.
    const std::vector<float> rounded = is_float_format(writer->format_name())
                                           ? rounded_for_hdr(picture, channels.size())
                                           : std::vector<float>();
    written = writer->write_image(type_of(channels[0].number),
                                  rounded.empty() ? channels[0].first : rounded.data());
  }
  if (!writer->close() || !written) throw std::runtime_error(writer->geterror());
  if (memory.buffer().empty()) throw std::runtime_error("OpenImageIO wrote nothing");
  return std::move(memory.buffer());
}

}  // namespace

extern "C" {

__attribute__((visibility("default"))) int microtrace_find_format_v4(const char* extension,
                                                                     MicrotraceFormat* format) {
  try {
    const std::unique_ptr<ImageOutput> writer = find_writer(extension);
    if (!writer) return 0;
    const std::string_view name = writer->format_name();
    format->is_float = is_float_format(name) ? 1 : 0;
    format->has_alpha = holds_alpha(name) ? 1 : 0;
    format->has_channels = 0;
    const Sides sides = sides_of(name);
    format->least_side = sides.least;
    format->most_side = sides.most;
    return 1;
  } catch (const std::exception&) {
    return 0;
  }
}

__attribute__((visibility("default"))) int microtrace_encode_v5(const MicrotracePicture* picture,
                                                                const char* extension,
                                                                MicrotraceSink out,
                                                                MicrotraceSink error,
                                                                void* context) {
  try {
    const std::vector<unsigned char> bytes = encode(*picture, extension);
    out(context, reinterpret_cast<const char*>(bytes.data()), bytes.size());
    return 0;
  } catch (const std::bad_alloc&) {
    return 2;
  } catch (const std::exception& e) {
    const std::string_view reason = e.what();
    error(context, reason.data(), reason.size());
    return 1;
  }
}
}
