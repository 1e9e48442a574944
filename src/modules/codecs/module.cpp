/// Decodes PNG, JPEG, WebP and KTX2, encodes PNG, compresses checkpoints, and decompresses arrays,
/// behind the C interface of io/image/codec_abi.hpp. The library loads this module if a scene has
/// images, the output is PNG, a checkpoint is read or written, or compressed arrays are read. It
/// uses small libraries, because loading OpenImageIO would take a quarter of a second and 130 MB.

#include "modules/codecs/codecs.hpp"

#include <cstring>

namespace {

bool begins(const unsigned char* bytes, std::size_t size, std::size_t at, const char* text) {
  const std::size_t length = std::strlen(text);
  return size >= at + length && std::memcmp(bytes + at, text, length) == 0;
}

}  // namespace

extern "C" {

__attribute__((visibility("default"))) int microtrace_decode_v1(const void* data, std::size_t size,
                                                                const MicrotraceImageSink* sink) {
  const auto* bytes = static_cast<const unsigned char*>(data);
  if (begins(bytes, size, 0, "\x89PNG\r\n\x1a\n")) return decode_png(bytes, size, *sink);
  if (begins(bytes, size, 0, "\xff\xd8\xff")) return decode_jpeg(bytes, size, *sink);
  if (begins(bytes, size, 0, "RIFF") && begins(bytes, size, 8, "WEBP")) {
    return decode_webp(bytes, size, *sink);
  }
  if (begins(bytes, size, 0, "\xabKTX 20\xbb\r\n\x1a\n")) return decode_ktx2(bytes, size, *sink);
  sink->complain(sink->context, "is neither PNG, JPEG, WebP nor KTX2");
  return 0;
}

__attribute__((visibility("default"))) int microtrace_encode_png_v4(const MicrotracePng* picture) {
  return encode_png(*picture);
}

__attribute__((visibility("default"))) std::size_t microtrace_compress_v1(void* to,
                                                                          std::size_t capacity,
                                                                          const void* from,
                                                                          std::size_t size) {
  return compress(to, capacity, from, size);
}

__attribute__((visibility("default"))) int microtrace_decompress_v1(void* to, std::size_t size,
                                                                    const void* from,
                                                                    std::size_t compressed) {
  return decompress(to, size, from, compressed);
}

__attribute__((visibility("default"))) int microtrace_inflate_v1(void* to, std::size_t size,
                                                                 const void* from,
                                                                 std::size_t compressed) {
  return inflate_raw(to, size, from, compressed);
}
}
