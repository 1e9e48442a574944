#include "io/image/ppm.hpp"

#include "io/image/srgb.hpp"

#include <cstddef>
#include <span>

namespace microtrace {
namespace {

void append_binary(std::span<const Vec3> row, std::string& out) {
  const std::size_t start = out.size();
  out.resize(start + 3 * row.size());
  char* byte = out.data() + start;
  for (const Vec3& color : row) {
    *byte++ = static_cast<char>(io::encode_srgb(color.x));
    *byte++ = static_cast<char>(io::encode_srgb(color.y));
    *byte++ = static_cast<char>(io::encode_srgb(color.z));
  }
}

void append_ascii(std::span<const Vec3> row, std::string& out) {
  constexpr std::size_t pixels_per_line = 5;  // "255 255 255 " five times is 59 characters
  for (std::size_t x = 0; x < row.size(); ++x) {
    const Vec3& color = row[x];
    out += std::to_string(io::encode_srgb(color.x));
    out += ' ';
    out += std::to_string(io::encode_srgb(color.y));
    out += ' ';
    out += std::to_string(io::encode_srgb(color.z));
    out += (x + 1 == row.size() || (x + 1) % pixels_per_line == 0) ? '\n' : ' ';
  }
}

}  // namespace

namespace io {

std::string ppm_header(ImageSize size, PpmEncoding encoding) {
  std::string header = encoding == PpmEncoding::binary ? "P6\n" : "P3\n";
  header += std::to_string(size.width);
  header += ' ';
  header += std::to_string(size.height);
  header += "\n255\n";
  return header;
}

void append_ppm_row(const Film& film, std::uint32_t y, PpmEncoding encoding, std::string& out) {
  if (encoding == PpmEncoding::binary) {
    append_binary(film.row(y), out);
  } else {
    append_ascii(film.row(y), out);
  }
}

}  // namespace io

std::string encode_ppm(const Film& film, PpmEncoding ppm) {
  std::string bytes = io::ppm_header(film.size(), ppm);
  for (std::uint32_t y = 0; y < film.size().height; ++y) io::append_ppm_row(film, y, ppm, bytes);
  return bytes;
}

}  // namespace microtrace
