/// Encodes pictures by OpenImageIO, behind the C interface of io/image_module_abi.hpp. It writes to
/// memory, so that the library alone touches the disk and sees every failure.

#include "io/image/module_abi.hpp"
#include "io/image/srgb.hpp"

#include <exception>
#include <memory>
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

/// The writer for an ending if it can write to memory, else null.
std::unique_ptr<ImageOutput> find_writer(const std::string& ending) {
  std::unique_ptr<ImageOutput> writer = ImageOutput::create(ending);
  // A failure leaves a message behind, which OpenImageIO would print at exit if nobody asked for
  // it.
  if (!writer) static_cast<void>(OIIO::geterror());
  if (writer && (!writer->supports("ioproxy") || std::string_view(writer->format_name()) == "null"))
    return nullptr;
  return writer;
}

/// Formats made for linear light.
bool is_float_format(std::string_view name) {
  return name == "openexr" || name == "hdr";
}

/// Returns the bytes of the file, or throws the reason as a std::runtime_error.
std::vector<unsigned char> encode(const MicrotracePicture& picture, const std::string& ending) {
  OIIO::attribute("threads", 1);
  const std::unique_ptr<ImageOutput> writer = find_writer(ending);
  if (!writer) throw std::runtime_error("OpenImageIO has no such writer");
  const std::string_view format = writer->format_name();
  const bool linear = is_float_format(format);

  ImageSpec spec(static_cast<int>(picture.width), static_cast<int>(picture.height), 3,
                 linear ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::UINT8);
  // TIFF would note it in a second directory, which OpenImageIO can't link when it writes to
  // memory.
  if (format != "tiff") spec.attribute("oiio:ColorSpace", linear ? "Linear" : "sRGB");
  // An empty one keeps writers from noting the time, by which no two files would be equal.
  spec.attribute("DateTime", "");

  OIIO::Filesystem::IOVecOutput memory;
  writer->set_ioproxy(&memory);
  std::string name = "picture.";
  name += ending;
  bool written = writer->open(name, spec);
  if (written && linear) {
    written = writer->write_image(OIIO::TypeDesc::FLOAT, picture.rgb);
  } else if (written) {
    const std::size_t count = std::size_t{picture.width} * picture.height * 3;
    std::vector<std::uint8_t> encoded(count);
    for (std::size_t i = 0; i < count; ++i) {
      encoded[i] = microtrace::io::encode_srgb(picture.rgb[i]);
    }
    written = writer->write_image(OIIO::TypeDesc::UINT8, encoded.data());
  }
  if (!writer->close() || !written) throw std::runtime_error(writer->geterror());
  return std::move(memory.buffer());
}

}  // namespace

extern "C" {

__attribute__((visibility("default"))) int microtrace_can_encode_v1(const char* ending) {
  try {
    return find_writer(ending) ? 1 : 0;
  } catch (const std::exception&) {
    return 0;
  }
}

__attribute__((visibility("default"))) int microtrace_encode_v1(const MicrotracePicture* picture,
                                                                const char* ending,
                                                                MicrotraceSink out,
                                                                MicrotraceSink error,
                                                                void* context) {
  try {
    const std::vector<unsigned char> bytes = encode(*picture, ending);
    out(context, reinterpret_cast<const char*>(bytes.data()), bytes.size());
    return 0;
  } catch (const std::exception& e) {
    const std::string_view reason = e.what();
    error(context, reason.data(), reason.size());
    return 1;
  }
}
}
