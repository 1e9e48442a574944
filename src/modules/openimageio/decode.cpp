/// Decodes images with OpenImageIO, behind the C interface of io/image/module_abi.hpp. Reads from
/// memory, because only the library accesses files.

#include "io/image/module_abi.hpp"

#include <cstdint>
#include <exception>
#include <memory>
#include <stdexcept>
#include <string>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

namespace {

using OIIO::ImageInput;
using OIIO::ImageSpec;
using OIIO::TypeDesc;

/// Makes an exception from OpenImageIO's error message. OpenImageIO prints messages that nobody
/// fetched at exit.
std::runtime_error complaint(const std::string& otherwise) {
  const std::string message = OIIO::geterror();
  if (!message.empty()) return std::runtime_error(message);
  return std::runtime_error(otherwise.empty() ? "it is damaged" : otherwise);
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

void decode(const void* bytes, std::size_t size, const std::string& extension,
            const MicrotraceColorSink& sink) {
  OIIO::attribute("threads", 1);
  OIIO::attribute("exr_threads", -1);  // uses only the calling thread
  OIIO::Filesystem::IOMemReader memory(const_cast<void*>(bytes), size);  // never writes to `bytes`
  const std::string name = "picture." + extension;
  ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);  // returns colors as stored in the file
  const std::unique_ptr<ImageInput> reader = ImageInput::create(extension, false, &config, &memory);
  if (!reader || !reader->supports("ioproxy") || std::string(reader->format_name()) == "null") {
    static_cast<void>(OIIO::geterror());
    throw std::runtime_error("OpenImageIO can't read files with this extension");
  }
  ImageSpec spec;
  reader->set_ioproxy(&memory);
  if (!reader->open(name, spec, config)) throw complaint(reader->geterror());
  if (spec.deep || spec.depth != 1 || spec.width < 1 || spec.height < 1 || spec.nchannels < 1)
    throw std::runtime_error("it is no plain picture of two dimensions");
  const int first = first_color(spec);
  const bool has_alpha = spec.alpha_channel == first + 3 && spec.nchannels > first + 3;
  const int count = spec.nchannels - first < 3 ? 1 : has_alpha ? 4 : 3;
  const MicrotraceColors colors{.width = static_cast<std::uint32_t>(spec.width),
                                .height = static_cast<std::uint32_t>(spec.height),
                                .channels = static_cast<std::uint32_t>(count),
                                .number = number_of(spec),
                                .x0 = 0,
                                .y0 = 0,
                                .whole_width = static_cast<std::uint32_t>(spec.width),
                                .whole_height = static_cast<std::uint32_t>(spec.height)};
  void* samples = sink.begin(sink.context, &colors);
  if (samples == nullptr) throw std::runtime_error("it is too large");
  if (!reader->read_image(0, 0, first, first + count, type_of(colors.number), samples))
    throw complaint(reader->geterror());
  reader->close();
}

}  // namespace

extern "C" {

__attribute__((visibility("default"))) int microtrace_decode_colors_v3(
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
