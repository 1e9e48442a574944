// The libFuzzer entry point for images. Calls the PNG, JPEG, WebP and KTX2 decoders through the
// module's interface.

#include "io/image/decode/decode_image.hpp"
#include "io/image/decode/image_header.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <string_view>
#include <variant>

namespace {

void expect(bool promise, const char* words) {
  if (promise) return;
  std::cerr << "broken promise: " << words << '\n';
  std::abort();
}

}  // namespace

// libFuzzer defines the name and the types.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace microtrace;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const io::ImageHeader header = io::read_image_header(bytes);
  // Larger images are valid, but take too much memory and time.
  constexpr std::uint64_t kMostPixels = std::uint64_t{1} << 20;
  if (std::uint64_t{header.width} * header.height > kMostPixels) return 0;
  const io::DecodedImage decoded = io::decode_image(bytes);
  expect(!decoded.no_module, "the decoders are there");
  if (!decoded.image) {
    expect(decoded.too_large || !decoded.complaint.empty(), "a failure has a reason");
    return 0;
  }
  const Image& image = *decoded.image;
  expect(header.format != io::ImageFormat::unknown, "decoded images have a known format");
  expect(image.width == header.width && image.height == header.height, "the size is the header's");
  expect(image.channels >= 1 && image.channels <= 4, "there are one to four channels");
  const std::size_t count = std::size_t{image.width} * image.height * image.channels;
  std::visit([&](const auto& samples) { expect(samples.size() == count, "all samples are there"); },
             image.samples);
  return 0;
}
