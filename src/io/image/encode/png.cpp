#include "io/image/encode/png.hpp"

#include "base/system/mapped_pages.hpp"
#include "io/image/encode/eight_bits.hpp"
#include "io/image/encode/lack_of_memory.hpp"
#include "io/image/encode/notes.hpp"
#include "io/module_function.hpp"

#include <microtrace/error.hpp>

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <utility>
#include <vector>

namespace microtrace::io {
namespace {

/// The encoder's input and output. It also stores failures, because exceptions must not propagate
/// through the module's frames.
struct Streams {
  const std::function<const void*(std::uint32_t)>& row;
  const std::function<void(std::string_view)>& out;
  std::string bytes{};  // bytes that were not yet passed on
  std::string reason{};
  std::exception_ptr thrown{};
};

const unsigned char* row_of(void* context, std::uint32_t y) {
  auto& streams = *static_cast<Streams*>(context);
  return static_cast<const unsigned char*>(streams.row(y));
}

int take_bytes(void* context, const void* bytes, std::size_t size) {
  constexpr std::size_t kBlock = std::size_t{1} << 16;
  auto& streams = *static_cast<Streams*>(context);
  try {
    streams.bytes.append(static_cast<const char*>(bytes), size);
    if (streams.bytes.size() < kBlock) return 1;
    streams.out(streams.bytes);
    streams.bytes.clear();
    return 1;
  } catch (...) {
    streams.thrown = std::current_exception();
    return 0;
  }
}

void take_reason(void* context, const char* text) {
  auto& streams = *static_cast<Streams*>(context);
  try {
    streams.reason = text;
  } catch (...) {
    streams.thrown = std::current_exception();
  }
}

}  // namespace

PngEncoder::PngEncoder(std::string file, Speed speed) : file_(std::move(file)), speed_(speed) {
  const ModuleFunction function = find_module_function(kCodecModuleFileName, kEncodePngName);
  if (function.address == nullptr) {
    throw Error(
        ErrorKind::unsupported, file_,
        "no PNG can be written: " + function.complaint +
            "; install libpng-dev, libjpeg-dev, libwebp-dev and libzstd-dev and build the target "
            "microtrace_codecs, set MICROTRACE_MODULE_PATH to its folder, or write .ppm");
  }
  encode_ = reinterpret_cast<MicrotraceEncodePng>(function.address);
}

void PngEncoder::encode(const Film& film, const std::function<void(std::string_view)>& out) const {
  const std::uint32_t channels = film.has_alpha() ? 4 : 3;
  std::vector<std::uint8_t> row(std::size_t{channels} * film.size().width);
  const std::vector<Note> notes = notes_of(film, false);
  std::vector<MicrotracePngText> texts;
  texts.reserve(notes.size());
  for (const Note& note : notes) {
    texts.push_back({.keyword = note.name.c_str(), .text = note.text.c_str()});
  }
  MicrotracePng picture{};
  picture.width = film.size().width;
  picture.height = film.size().height;
  picture.channels = channels;
  picture.depth = 8;
  picture.is_srgb = film.display.srgb ? 1 : 0;
  picture.texts = texts.data();
  picture.text_count = texts.size();
  const auto encoded_row = [&](std::uint32_t y) {
    encode_row(film, y, row.data());
    return row.data();
  };
  encode(picture, encoded_row, out);
}

void PngEncoder::encode(MicrotracePng picture, const std::function<const void*(std::uint32_t)>& row,
                        const std::function<void(std::string_view)>& out) const {
  Streams streams{row, out};
  picture.is_fast = speed_ == Speed::fast ? 1 : 0;
  picture.context = &streams;
  picture.row = row_of;
  picture.take = take_bytes;
  picture.complain = take_reason;
  const bool done = encode_(&picture) != 0;
  if (streams.thrown) std::rethrow_exception(streams.thrown);
  constexpr std::size_t kWork = std::size_t{1} << 20U;  // more than libpng and zlib take
  if (!done && !can_map_pages(kWork)) throw lack_of_memory(file_);
  if (!done) throw Error(ErrorKind::io, file_, "can't be encoded: " + streams.reason);
  out(streams.bytes);
}

namespace {

template <class Sample>
std::string encode_gray(ImageSize size, std::span<const Sample> samples) {
  assert(samples.size() == std::size_t{size.width} * size.height);
  MicrotracePng picture{};
  picture.width = size.width;
  picture.height = size.height;
  picture.channels = 1;
  picture.depth = 8 * sizeof(Sample);
  std::string file;
  const auto row = [&](std::uint32_t y) { return &samples[std::size_t{y} * size.width]; };
  PngEncoder("a gray picture").encode(picture, row, [&](std::string_view bytes) { file += bytes; });
  return file;
}

}  // namespace

std::string encode_gray_png(ImageSize size, std::span<const std::uint8_t> samples) {
  return encode_gray(size, samples);
}

std::string encode_gray_png(ImageSize size, std::span<const std::uint16_t> samples) {
  return encode_gray(size, samples);
}

}  // namespace microtrace::io
