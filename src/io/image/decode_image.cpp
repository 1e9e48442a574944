#include "io/image/decode_image.hpp"

#include "io/image/codec_abi.hpp"
#include "io/module_function.hpp"

#include <new>
#include <utility>

namespace microtrace::io {
namespace {

/// An exception may not pass the module's frames: what goes wrong is kept here.
void* begin(void* context, const MicrotraceImageHeader* header) {
  auto& result = *static_cast<DecodedImage*>(context);
  const std::uint64_t pixels = std::uint64_t{header->width} * header->height;
  if (pixels > max_texture_pixels) {
    result.too_large = true;
    return nullptr;
  }
  try {
    Image image{.width = header->width, .height = header->height, .channels = header->channels};
    void* samples = nullptr;
    const std::size_t count = pixels * header->channels;
    if (header->depth == 16) {
      samples = image.samples.emplace<std::vector<std::uint16_t>>(count).data();
    } else {
      samples = image.samples.emplace<std::vector<std::uint8_t>>(count).data();
    }
    result.image = std::move(image);
    return samples;
  } catch (const std::bad_alloc&) {
    result.too_large = true;
    return nullptr;
  }
}

void complain(void* context, const char* text) {
  auto& result = *static_cast<DecodedImage*>(context);
  try {
    if (result.complaint.empty()) result.complaint = text;
  } catch (const std::bad_alloc&) {
    result.too_large = true;
  }
}

}  // namespace

DecodedImage decode_image(std::string_view bytes) {
  static const ModuleFunction codec = find_module_function(codec_module_file_name, decode_name);
  if (codec.address == nullptr) {
    return {.complaint = codec.complaint +
                         "; build the target microtrace_codecs, or set MICROTRACE_MODULE_PATH to "
                         "its folder",
            .no_module = true};
  }
  DecodedImage result;
  const MicrotraceImageSink sink{&result, begin, complain};
  const auto decode = reinterpret_cast<MicrotraceDecode>(codec.address);
  if (decode(bytes.data(), bytes.size(), &sink) == 0) result.image.reset();
  return result;
}

}  // namespace microtrace::io
