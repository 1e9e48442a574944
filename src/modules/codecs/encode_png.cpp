#include "modules/codecs/codecs.hpp"

#include <array>
#include <bit>
#include <csetjmp>
#include <cstddef>
#include <png.h>
#include <span>
#include <zlib.h>

namespace {

const MicrotracePng& picture_of(png_voidp pointer) {
  return *static_cast<const MicrotracePng*>(pointer);
}

void fail(png_structp png, png_const_charp message) {
  const MicrotracePng& picture = picture_of(png_get_error_ptr(png));
  picture.complain(picture.context, message);
  png_longjmp(png, 1);
}

void ignore(png_structp, png_const_charp) {}

void write(png_structp png, png_bytep bytes, std::size_t size) {
  const MicrotracePng& picture = picture_of(png_get_io_ptr(png));
  if (picture.take(picture.context, bytes, size) == 0) png_error(png, "the file can't be written");
}

void flush(png_structp) {}

void write_chunk(png_structp png, const char* name, std::span<const png_byte> data) {
  png_write_chunk(png, reinterpret_cast<png_const_bytep>(name), data.data(), data.size());
}

/// Writes the chunks of sRGB colors, which versions of libpng write in different orders.
void write_color_space(png_structp png) {
  // A gamma of 1/2.2, and x and y of white, red, green and blue, times 100000 (PNG specification,
  // third edition, section 11.3.2.5).
  constexpr png_uint_32 kGamma = 45455;
  constexpr std::array<png_uint_32, 8> kPoints = {31270, 32900, 64000, 33000,
                                                  30000, 60000, 15000, 6000};
  constexpr std::array<png_byte, 1> kIntent = {PNG_sRGB_INTENT_RELATIVE};
  std::array<png_byte, 4> gamma;
  png_save_uint_32(gamma.data(), kGamma);
  std::array<png_byte, 4 * kPoints.size()> points;
  for (std::size_t i = 0; i < kPoints.size(); ++i) png_save_uint_32(&points[4 * i], kPoints[i]);
  write_chunk(png, "gAMA", gamma);
  write_chunk(png, "sRGB", kIntent);
  write_chunk(png, "cHRM", points);
}

int color_type(std::uint32_t channels) {
  if (channels == 1) return PNG_COLOR_TYPE_GRAY;
  return channels == 4 ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB;
}

}  // namespace

// This function must not contain objects with destructors, because libpng jumps after an error.
int encode_png(const MicrotracePng& picture) {
  auto* pointer = const_cast<MicrotracePng*>(&picture);
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, pointer, fail, ignore);
  if (png == nullptr) {
    picture.complain(picture.context, "libpng does not start");
    return 0;
  }
  png_infop info = png_create_info_struct(png);
  volatile int done = 0;  // changed after setjmp, read after the jump
  if (info != nullptr && setjmp(png_jmpbuf(png)) == 0) {
    png_set_write_fn(png, pointer, write, flush);
    png_set_user_limits(png, 0x7FFFFFFF, 0x7FFFFFFF);
    png_set_IHDR(png, info, picture.width, picture.height, static_cast<int>(picture.depth),
                 color_type(picture.channels), PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    for (std::size_t i = 0; i < picture.text_count; ++i) {
      png_text text{};
      text.compression = PNG_TEXT_COMPRESSION_NONE;
      text.key = const_cast<char*>(picture.texts[i].keyword);  // libpng only reads the text
      text.text = const_cast<char*>(picture.texts[i].text);
      png_set_text(png, info, &text, 1);
    }
    // Masks have long runs of equal bytes. Searching only for runs takes a third of the time and
    // makes the files smaller; filters would double the time and make the files larger.
    if (picture.channels == 1 && picture.depth == 8) {
      png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_NONE);
      png_set_compression_strategy(png, Z_RLE);
    }
    if (picture.is_fast != 0) {
      png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
      png_set_compression_level(png, 1);
    }
    png_write_info_before_PLTE(png, info);
    if (picture.is_srgb != 0) write_color_space(png);
    png_write_info(png, info);
    if (picture.depth == 16 && std::endian::native == std::endian::little) png_set_swap(png);
    for (std::uint32_t y = 0; y < picture.height; ++y) {
      png_write_row(png, picture.row(picture.context, y));
    }
    png_write_end(png, nullptr);
    done = 1;
  }
  png_destroy_write_struct(&png, &info);
  return done;
}
