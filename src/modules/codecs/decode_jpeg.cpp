#include "modules/codecs/codecs.hpp"

#include <csetjmp>
#include <cstdint>
#include <cstdio>
#include <jpeglib.h>

// The numbers of the messages depend on the version that jpeglib.h defines.
#include <jerror.h>

// Decoding gives the same samples on every machine. libjpeg-turbo's slow integer transform
// (JDCT_ISLOW), triangular upsampling and color conversion use integer arithmetic, and their SIMD
// code is bit-exact. The fast and the floating-point transforms are not bit-exact and are therefore
// not used.

namespace {

/// Stack frames that the jump after an error leaves must not contain objects with destructors.
struct ErrorManager {
  jpeg_error_mgr base;  ///< first member, so that libjpeg's pointer can be cast
  std::jmp_buf jump;
  const MicrotraceImageSink* sink;
};

void complain(j_common_ptr info) {
  char text[JMSG_LENGTH_MAX];
  info->err->format_message(info, text);
  const auto* sink = reinterpret_cast<const ErrorManager*>(info->err)->sink;
  sink->complain(sink->context, text);
}

void fail(j_common_ptr info) {
  complain(info);
  std::longjmp(reinterpret_cast<ErrorManager*>(info->err)->jump, 1);
}

/// Returns true for a warning about something that changes no pixel: unusual headers, and unknown
/// bytes before the first scan or after the last row, which some cameras write.
bool is_harmless(j_common_ptr info) {
  const int code = info->err->msg_code;
  if (code == JWRN_JFIF_MAJOR || code == JWRN_ADOBE_XFORM) return true;
  const auto* jpeg = reinterpret_cast<j_decompress_ptr>(info);
  const bool is_at_end = jpeg->output_height > 0 && jpeg->output_scanline >= jpeg->output_height;
  return code == JWRN_EXTRANEOUS_DATA && (jpeg->input_scan_number == 0 || is_at_end);
}

/// Handles a message from libjpeg. Level -1 means damaged data, which is reported only once.
void take_message(j_common_ptr info, int level) {
  if (level < 0 && !is_harmless(info) && info->err->num_warnings++ == 0) complain(info);
}

/// Limits the number of scans, because a small file can contain very many scans of a large image.
/// Each takes time for all blocks of 8 x 8 samples.
void limit_scans(j_common_ptr info) {
  constexpr double kMaxScans = 500, kUsualScans = 32, kMaxBlocks = 4e8;
  auto* jpeg = reinterpret_cast<j_decompress_ptr>(info);
  const double scans = jpeg->input_scan_number;
  const std::uint64_t columns = (jpeg->image_width + 7) / 8, rows = (jpeg->image_height + 7) / 8;
  const double blocks = static_cast<double>(columns * rows) * jpeg->num_components;
  if (scans <= kUsualScans || (scans <= kMaxScans && scans * blocks <= kMaxBlocks)) return;
  const auto* manager = reinterpret_cast<const ErrorManager*>(info->err);
  manager->sink->complain(manager->sink->context, "has too many scans for its size");
  std::longjmp(reinterpret_cast<ErrorManager*>(info->err)->jump, 1);
}

/// Converts CMYK to RGB. Adobe programs store inverted CMYK and mark their files with an Adobe
/// segment.
void rgb_from_cmyk(const unsigned char* cmyk, unsigned char* rgb, std::size_t pixels,
                   bool inverted) {
  for (std::size_t i = 0; i < pixels; ++i, cmyk += 4, rgb += 3) {
    const int k = inverted ? cmyk[3] : 255 - cmyk[3];
    for (int c = 0; c < 3; ++c) {
      const int light = inverted ? cmyk[c] : 255 - cmyk[c];
      rgb[c] = static_cast<unsigned char>((light * k + 127) / 255);
    }
  }
}

void set_up(jpeg_decompress_struct& jpeg) {
  if (jpeg.jpeg_color_space == JCS_GRAYSCALE) {
    jpeg.out_color_space = JCS_GRAYSCALE;
  } else {
    jpeg.out_color_space = jpeg.num_components == 4 ? JCS_CMYK : JCS_RGB;
  }
  jpeg.dct_method = JDCT_ISLOW;
  jpeg.do_fancy_upsampling = TRUE;
  jpeg.do_block_smoothing = FALSE;
}

void read_rows(jpeg_decompress_struct& jpeg, unsigned char* samples, std::size_t channels) {
  const std::size_t stride = channels * jpeg.output_width;
  if (jpeg.out_color_space != JCS_CMYK) {
    while (jpeg.output_scanline < jpeg.output_height) {
      JSAMPROW row = samples + jpeg.output_scanline * stride;
      jpeg_read_scanlines(&jpeg, &row, 1);
    }
    return;
  }
  // libjpeg owns this memory and releases it with its other memory.
  JSAMPARRAY row = jpeg.mem->alloc_sarray(reinterpret_cast<j_common_ptr>(&jpeg), JPOOL_IMAGE,
                                          jpeg.output_width * 4, 1);
  for (; jpeg.output_scanline < jpeg.output_height; samples += stride) {
    jpeg_read_scanlines(&jpeg, row, 1);
    rgb_from_cmyk(row[0], samples, jpeg.output_width, jpeg.saw_Adobe_marker != 0);
  }
}

}  // namespace

int decode_jpeg(const unsigned char* bytes, std::size_t size, const MicrotraceImageSink& sink) {
  jpeg_decompress_struct jpeg{};
  jpeg_progress_mgr progress{};
  ErrorManager manager{};
  manager.sink = &sink;
  jpeg.err = jpeg_std_error(&manager.base);
  manager.base.error_exit = fail;
  manager.base.emit_message = take_message;
  volatile int done = 0;
  if (setjmp(manager.jump) == 0) {
    jpeg_create_decompress(&jpeg);
    progress.progress_monitor = limit_scans;
    jpeg.progress = &progress;
    jpeg_mem_src(&jpeg, bytes, size);
    jpeg_read_header(&jpeg, TRUE);
    set_up(jpeg);
    const unsigned channels = jpeg.out_color_space == JCS_GRAYSCALE ? 1 : 3;
    const MicrotraceImageHeader header{jpeg.image_width, jpeg.image_height, channels, 8};
    auto* samples = static_cast<unsigned char*>(sink.begin(sink.context, &header));
    if (samples != nullptr) {
      jpeg_start_decompress(&jpeg);
      read_rows(jpeg, samples, channels);
      jpeg_finish_decompress(&jpeg);
      done = 1;
    }
  }
  jpeg_destroy_decompress(&jpeg);
  return done;
}
