#include "io/image/encode/png.hpp"

#include "io/image/encode/eight_bits.hpp"
#include "io/image/encode/notes.hpp"
#include "io/module_function.hpp"

#include <microtrace/error.hpp>

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
  const Film& film;
  const std::function<void(std::string_view)>& out;
  std::vector<std::uint8_t> row;
  std::string bytes{};  // bytes that were not yet passed on
  std::string reason{};
  std::exception_ptr thrown{};
};

const unsigned char* row_of(void* context, std::uint32_t y) {
  auto& streams = *static_cast<Streams*>(context);
  encode_row(streams.film, y, streams.row.data());
  return streams.row.data();
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

PngEncoder::PngEncoder(std::string file) : file_(std::move(file)) {
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
  Streams streams{film, out, std::vector<std::uint8_t>(std::size_t{channels} * film.size().width)};
  const std::vector<Note> notes = notes_of(film.display, false);
  std::vector<MicrotracePngText> texts;
  for (const Note& note : notes) {
    texts.push_back({.keyword = note.name.c_str(), .text = note.text.c_str()});
  }
  const MicrotracePng picture{.width = film.size().width,
                              .height = film.size().height,
                              .channels = channels,
                              .is_srgb = film.display.srgb ? 1U : 0U,
                              .texts = texts.data(),
                              .text_count = texts.size(),
                              .context = &streams,
                              .row = row_of,
                              .take = take_bytes,
                              .complain = take_reason};
  const bool done = encode_(&picture) != 0;
  if (streams.thrown) std::rethrow_exception(streams.thrown);
  if (!done) throw Error(ErrorKind::io, file_, "can't be encoded: " + streams.reason);
  out(streams.bytes);
}

}  // namespace microtrace::io
