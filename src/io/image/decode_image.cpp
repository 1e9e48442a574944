#include "io/image/decode_image.hpp"

#include "io/image/codec_abi.hpp"
#include "io/image/module_folders.hpp"

#include <dlfcn.h>
#include <new>
#include <utility>

namespace microtrace::io {
namespace {

struct Codec {
  MicrotraceDecode decode = nullptr;
  std::string complaint{};  ///< where there is none
};

Codec load_codec() {
  const std::string remedy =
      "; build the target microtrace_codecs, or set MICROTRACE_MODULE_PATH to its folder";
  std::string sought;
  for (const std::filesystem::path& folder : module_folders()) {
    const std::filesystem::path path = folder / codec_module_file_name;
    sought += (sought.empty() ? "" : ", ") + folder.string();
    std::error_code error;
    if (!std::filesystem::exists(path, error)) continue;
    void* module = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    void* decode = module != nullptr ? ::dlsym(module, decode_name) : nullptr;
    if (decode != nullptr) return {.decode = reinterpret_cast<MicrotraceDecode>(decode)};
    const char* reason = ::dlerror();
    return {.complaint = "the module " + path.string() + " can't be used: " +
                         (reason != nullptr ? reason : "it has no decoder") + remedy};
  }
  return {.complaint = std::string("the module ") + codec_module_file_name + " is not in " +
                       sought + remedy};
}

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
  static const Codec codec = load_codec();
  if (codec.decode == nullptr) return {.complaint = codec.complaint, .no_module = true};
  DecodedImage result;
  const MicrotraceImageSink sink{&result, begin, complain};
  if (codec.decode(bytes.data(), bytes.size(), &sink) == 0) result.image.reset();
  return result;
}

}  // namespace microtrace::io
