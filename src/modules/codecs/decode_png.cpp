#include "modules/codecs/codecs.hpp"

#include <algorithm>
#include <bit>
#include <csetjmp>
#include <cstdlib>
#include <cstring>
#include <png.h>

namespace {

/// The input of libpng, and the jump target after an error. Stack frames that the jump leaves must
/// not contain objects with destructors.
struct Source {
  const unsigned char* bytes;
  std::size_t left;
  const MicrotraceImageSink& sink;
};

void fail(png_structp png, png_const_charp message) {
  const auto* source = static_cast<const Source*>(png_get_error_ptr(png));
  source->sink.complain(source->sink.context, message);
  png_longjmp(png, 1);
}

void ignore(png_structp, png_const_charp) {}

void read(png_structp png, png_bytep to, std::size_t size) {
  auto* source = static_cast<Source*>(png_get_io_ptr(png));
  if (size > source->left) png_error(png, "the file is cut off");
  std::memcpy(to, source->bytes, size);
  source->bytes += size;
  source->left -= size;
}

/// Makes libpng skip chunks that don't affect the samples, such as profiles, gamma and texts.
void skip_ancillary_chunks(png_structp png) {
  constexpr png_byte kNames[] =
      "bKGD\0cHRM\0eXIf\0gAMA\0hIST\0iCCP\0iTXt\0oFFs\0pCAL\0pHYs\0sBIT\0sCAL\0sPLT\0sRGB\0"
      "sTER\0tEXt\0tIME\0zTXt";
  png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, nullptr, 0);
  png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, kNames, sizeof kNames / 5);
}

/// Requests whole rows with 8 or 16 bits per sample. libpng expands palettes, low bit depths and
/// transparent colors.
void set_transformations(png_structp png, png_infop info) {
  png_set_expand(png);
  if (std::endian::native == std::endian::little) png_set_swap(png);
  png_set_interlace_handling(png);
  png_read_update_info(png, info);
}

}  // namespace

int decode_png(const unsigned char* bytes, std::size_t size, const MicrotraceImageSink& sink) {
  Source source{bytes, size, sink};
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &source, fail, ignore);
  if (png == nullptr) {
    sink.complain(sink.context, "libpng does not start");
    return 0;
  }
  png_infop info = png_create_info_struct(png);
  volatile int done = 0;  // volatile, because it is changed after setjmp and read after the jump
  if (info != nullptr && setjmp(png_jmpbuf(png)) == 0) {
    png_set_read_fn(png, &source, read);
    png_set_user_limits(png, 0x7FFFFFFF, 0x7FFFFFFF);  // begin() enforces the limits
    skip_ancillary_chunks(png);
    png_read_info(png, info);
    set_transformations(png, info);
    const MicrotraceImageHeader header{png_get_image_width(png, info),
                                       png_get_image_height(png, info), png_get_channels(png, info),
                                       png_get_bit_depth(png, info)};
    auto* samples = static_cast<png_bytep>(sink.begin(sink.context, &header));
    if (samples != nullptr) {
      const std::size_t stride = png_get_rowbytes(png, info);
      for (int pass = png_set_interlace_handling(png); pass > 0; --pass) {
        for (std::size_t y = 0; y < header.height; ++y) {
          png_read_row(png, samples + y * stride, nullptr);
          done = 1;  // an incomplete image has at least a row
        }
      }
    }
  }
  png_destroy_read_struct(&png, &info, nullptr);
  return done;
}
