#include "modules/codecs/codecs.hpp"

#include <webp/decode.h>

// libwebp's decoder uses integer arithmetic, and its SIMD code gives the same bits as its scalar
// code.

int decode_webp(const unsigned char* bytes, std::size_t size, const MicrotraceImageSink& sink) {
  WebPBitstreamFeatures features{};
  const auto fail = [&sink](const char* reason) {
    sink.complain(sink.context, reason);
    return 0;
  };
  if (WebPGetFeatures(bytes, size, &features) != VP8_STATUS_OK) {
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
