/// Decodes images with the codec module and writes size and samples to standard output, for
/// comparison between machines.
///
/// usage: decode_images MODULE IMAGE [--plain]
///
/// --plain disables the vector code of libwebp; for libjpeg-turbo the environment variable
/// JSIMD_FORCENONE=1 does the same.

#include "io/image/codec_abi.hpp"

#include <cstdio>
#include <cstring>
#include <dlfcn.h>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace {

struct Picture {
  MicrotraceImageHeader header{};
  std::vector<unsigned char> samples;
};

void* begin(void* context, const MicrotraceImageHeader* header) {
  auto& picture = *static_cast<Picture*>(context);
  picture.header = *header;
  picture.samples.resize(std::size_t{header->width} * header->height * header->channels *
                         (header->depth / 8));
  return picture.samples.data();
}

void complain(void*, const char* text) {
  std::fprintf(stderr, "%s\n", text);
}

/// Returns false if the library does not export the variable through which it queries the
/// processor's features.
bool turn_off_vectors_of_webp() {
  void* webp = dlopen("libwebp.so.7", RTLD_NOW | RTLD_NOLOAD);
  void* variable = webp != nullptr ? dlsym(webp, "VP8GetCPUInfo") : nullptr;
  if (variable == nullptr) return false;
  const void* none = nullptr;
  std::memcpy(variable, &none, sizeof none);
  return true;
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 3) return 2;
  void* module = dlopen(arguments[1], RTLD_NOW);
  if (module == nullptr) {
    complain(nullptr, dlerror());
    return 1;
  }
  if (count > 3 && std::strcmp(arguments[3], "--plain") == 0 && !turn_off_vectors_of_webp()) {
    complain(nullptr, "libwebp's vector code can't be turned off");
    return 1;
  }
  const auto decode =
      reinterpret_cast<MicrotraceDecode>(dlsym(module, microtrace::io::kDecodeName));
  std::ifstream file(arguments[2], std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  Picture picture;
  const MicrotraceImageSink sink{&picture, begin, complain};
  if (decode == nullptr || decode(bytes.data(), bytes.size(), &sink) == 0) return 1;
  std::printf("%u x %u, %u channels of %u bits\n", picture.header.width, picture.header.height,
              picture.header.channels, picture.header.depth);
  std::fwrite(picture.samples.data(), 1, picture.samples.size(), stdout);
  return 0;
}
