/// Encodes images with OpenEXR, behind the C interface of io/image/module_abi.hpp. Writes to
/// memory, because only the library accesses files and reports failures.

#include "io/image/module_abi.hpp"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <cstring>
#include <exception>
#include <new>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace {

using Imath::Box2i;
using Imath::V2i;

/// An output file in memory. OpenEXR seeks back to write the offsets of its chunks.
class MemoryFile : public Imf::OStream {
 public:
  MemoryFile() : OStream("picture.exr") {}

  void write(const char* bytes, int count) override {
    const auto size = static_cast<std::size_t>(count);
    if (bytes_.size() < place_ + size) bytes_.resize(place_ + size);
    std::memcpy(bytes_.data() + place_, bytes, size);
    place_ += size;
  }
  std::uint64_t tellp() override { return place_; }
  void seekp(std::uint64_t place) override { place_ = static_cast<std::size_t>(place); }

  [[nodiscard]] std::string take_bytes() { return std::move(bytes_); }

 private:
  std::string bytes_;
  std::size_t place_ = 0;
};

Imf::PixelType type_of(MicrotraceNumber number) {
  return number == kMicrotraceU32 ? Imf::UINT : Imf::FLOAT;
}

/// Returns the box of pixels that starts at (x0, y0). Its ends are inclusive, as OpenEXR requires.
Box2i box_of(std::uint32_t x0, std::uint32_t y0, std::uint32_t width, std::uint32_t height) {
  const V2i first(static_cast<int>(x0), static_cast<int>(y0));
  return {first, first + V2i(static_cast<int>(width) - 1, static_cast<int>(height) - 1)};
}

std::string encode(const MicrotracePicture& picture) {
  const Box2i window = box_of(picture.x0, picture.y0, picture.width, picture.height);
  Imf::Header header(box_of(0, 0, picture.whole_width, picture.whole_height), window);
  header.compression() = Imf::ZIP_COMPRESSION;
  for (const MicrotraceNote& note : std::span(picture.notes, picture.note_count))
    header.insert(note.name, Imf::StringAttribute(note.text));
  Imf::FrameBuffer pixels;
  for (const MicrotraceChannel& channel : std::span(picture.channels, picture.channel_count)) {
    header.channels().insert(channel.name, Imf::Channel(type_of(channel.number)));
    pixels.insert(channel.name, Imf::Slice::Make(type_of(channel.number), channel.first, window,
                                                 channel.stride, channel.stride * picture.width));
  }
  MemoryFile file;
  {
    Imf::OutputFile output(file, header, 0);  // 0: no threads
    output.setFrameBuffer(pixels);
    output.writePixels(static_cast<int>(picture.height));
  }  // the destructor writes the chunk table
  return file.take_bytes();
}

}  // namespace

extern "C" {

__attribute__((visibility("default"))) int microtrace_find_format_v4(const char* extension,
                                                                     MicrotraceFormat* format) {
  if (std::string_view(extension) != "exr") return 0;
  *format = {.is_float = 1,
             .has_alpha = 1,
             .has_channels = 1,
             .least_side = 1,
             .most_side = kMicrotraceAnySide};
  return 1;
}

__attribute__((visibility("default"))) int microtrace_encode_v5(const MicrotracePicture* picture,
                                                                const char* /*extension*/,
                                                                MicrotraceSink out,
                                                                MicrotraceSink error,
                                                                void* context) {
  try {
    const std::string bytes = encode(*picture);
    out(context, bytes.data(), bytes.size());
    return 0;
  } catch (const std::bad_alloc&) {
    return 2;
  } catch (const std::exception& e) {
    const std::string_view reason = e.what();
    error(context, reason.data(), reason.size());
    return 1;
  }
}
}
