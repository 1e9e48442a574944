#include "io/image/encode/ppm.hpp"

#include "base/system/float_environment.hpp"
#include "io/image/encode/eight_bits.hpp"

#include <microtrace/error.hpp>

#include <cstddef>
#include <vector>

namespace microtrace {
namespace {

void append_ascii(const std::vector<std::uint8_t>& row, std::string& out) {
  constexpr std::size_t kNumbersPerLine = 15;  // at most 60 of the allowed 70 characters
  for (std::size_t i = 0; i < row.size(); ++i) {
    out += std::to_string(row[i]);
    out += (i + 1 == row.size() || (i + 1) % kNumbersPerLine == 0) ? '\n' : ' ';
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
  const std::size_t numbers = std::size_t{3} * film.size().width;
  if (encoding == PpmEncoding::binary) {
    const std::size_t start = out.size();
    out.resize(start + numbers);
    encode_row(film, y, reinterpret_cast<std::uint8_t*>(out.data() + start));
  } else {
    std::vector<std::uint8_t> row(numbers);
    encode_row(film, y, row.data());
    append_ascii(row, out);
  }
}

}  // namespace io

std::string encode_ppm(const Film& film, PpmEncoding ppm) {
  const FloatEnvironment environment;
  if (film.has_alpha()) throw Error(ErrorKind::usage, "", "a picture with alpha can't be PPM");
  std::string bytes = io::ppm_header(film.size(), ppm);
  const ImageSize size = film.size();
  if (ppm == PpmEncoding::binary)
    bytes.reserve(bytes.size() + std::size_t{3} * size.width * size.height);
  for (std::uint32_t y = 0; y < size.height; ++y) io::append_ppm_row(film, y, ppm, bytes);
  return bytes;
}

}  // namespace microtrace
