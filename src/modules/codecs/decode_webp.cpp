#include "modules/codecs/codecs.hpp"

#include <string_view>
#include <webp/decode.h>

// libwebp's decoder uses integer arithmetic, and its SIMD code gives the same bits as its scalar
// code.

namespace {

/// Returns true if the first chunk is one of those that RFC 9649, sections 2.5 to 2.7, allows.
/// After any other chunk, libwebp would decode the bytes that follow as a picture without a
/// container, whose size is arbitrary.
bool begins_with_a_picture(std::string_view bytes) {
  const std::string_view kind = bytes.substr(12, 4);
  return kind == "VP8 " || kind == "VP8L" || kind == "VP8X";
}

}  // namespace

int decode_webp(const unsigned char* bytes, std::size_t size, const MicrotraceImageSink& sink) {
  WebPBitstreamFeatures features{};
  const auto fail = [&sink](const char* reason) {
    sink.complain(sink.context, reason);
    return 0;
  };
  const std::string_view file(reinterpret_cast<const char*>(bytes), size);
  if (size < 16 || !begins_with_a_picture(file) ||
      WebPGetFeatures(bytes, size, &features) != VP8_STATUS_OK) {
    return fail("the WebP header is damaged");
  }
  if (features.has_animation != 0) return fail("is an animation, which textures can't be");
  const MicrotraceImageHeader header{static_cast<std::uint32_t>(features.width),
                                     static_cast<std::uint32_t>(features.height),
                                     features.has_alpha != 0 ? 4U : 3U, 8};
  auto* samples = static_cast<unsigned char*>(sink.begin(sink.context, &header));
  if (samples == nullptr) return 0;
  const std::size_t stride = std::size_t{header.width} * header.channels;
  const auto decode = header.channels == 4 ? WebPDecodeRGBAInto : WebPDecodeRGBInto;
  if (decode(bytes, size, samples, stride * header.height, static_cast<int>(stride)) == nullptr) {
    return fail("the WebP data is damaged");
  }
  return 1;
}
