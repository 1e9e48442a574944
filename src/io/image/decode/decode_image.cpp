#include "io/image/decode/decode_image.hpp"

#include "base/memory_account.hpp"
#include "base/system/mapped_pages.hpp"
#include "io/image/codec_abi.hpp"
#include "io/image/decode/image_header.hpp"
#include "io/module_function.hpp"

#include <microtrace/error.hpp>

#include <exception>
#include <new>
#include <utility>

namespace microtrace::io {
namespace {

/// The decoder's output. It also stores failures, because exceptions must not propagate through the
/// module's frames.
struct Decoding {
  ImageHeader header{};
  DecodedImage result{};
  MemoryAccount work{memory_account().budget()};
  std::exception_ptr failure{};
};

/// Keeps the last complaint: decoders may complain before they fail.
void complain(void* context, const char* text) {
  DecodedImage& result = static_cast<Decoding*>(context)->result;
  try {
    result.complaint = text;
  } catch (const std::bad_alloc&) {
    result.too_large = true;
  }
}

/// An upper bound of a decoder's working memory in bytes per pixel, for example for coefficients of
/// a progressive JPEG or colors of a WebP. The decoded pixels are counted separately.
constexpr std::uint64_t kWorkOfPixel = 6;

/// Returns true if a decoder may have failed because memory ran out, which most libraries report
/// like damage. Textures would then be white.
bool lacks_memory(const ImageHeader& header) {
  constexpr std::uint64_t kLibraries = std::uint64_t{4} << 20U;  // for tables and input
  const std::uint64_t pixels = std::uint64_t{header.width} * header.height;
  return !can_map_pages(2 * kWorkOfPixel * pixels + kLibraries);
}

void* begin(void* context, const MicrotraceImageHeader* header) {
  auto& decoding = *static_cast<Decoding*>(context);
  DecodedImage& result = decoding.result;
  // Callers limit memory by the size in the header. Decoders can find another size in a damaged
  // file.
  if (header->width != decoding.header.width || header->height != decoding.header.height) {
    complain(context, "its header is truncated or damaged");
    return nullptr;
  }
  const std::uint64_t pixels = std::uint64_t{header->width} * header->height;
  if (pixels > kMaxTexturePixels) {
    result.too_large = true;
    return nullptr;
  }
  try {
    Image image{.width = header->width, .height = header->height, .channels = header->channels};
    void* samples = nullptr;
    const std::size_t count = pixels * header->channels;
    take_memory(count * (header->depth / 8), "the pixels of images");
    decoding.work.take(pixels * kWorkOfPixel, "decoding images");
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
  } catch (const Error&) {
    decoding.failure = std::current_exception();
    return nullptr;
  }
}

}  // namespace

DecodedImage decode_image(std::string_view bytes) {
  static const ModuleFunction codec = find_module_function(kCodecModuleFileName, kDecodeName);
  if (codec.address == nullptr) {
    return {.complaint = codec.complaint +
                         "; build the target microtrace_codecs, or set MICROTRACE_MODULE_PATH to "
                         "its folder",
            .no_module = true};
  }
  Decoding decoding{.header = read_image_header(bytes)};
  const MicrotraceImageSink sink{&decoding, begin, complain};
  const auto decode = reinterpret_cast<MicrotraceDecode>(codec.address);
  const bool is_decoded = decode(bytes.data(), bytes.size(), &sink) != 0;
  if (decoding.failure) std::rethrow_exception(decoding.failure);
  if (!decoding.result.complaint.empty() && lacks_memory(decoding.header))
    decoding.result.too_large = true;
  if (!is_decoded || decoding.result.too_large) decoding.result.image.reset();
  return std::move(decoding.result);
}

}  // namespace microtrace::io
