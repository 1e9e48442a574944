#include "io/image/decode/decode_ppm.hpp"

#include "base/memory_account.hpp"
#include "io/image/decode/decode_image.hpp"

#include <microtrace/error.hpp>

#include <cstddef>
#include <cstdint>

namespace microtrace::io {
namespace {

class PpmReader {
 public:
  PpmReader(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  [[nodiscard]] Image read() {
    const bool is_text = bytes_[1] == '2' || bytes_[1] == '3';
    const bool is_gray = bytes_[1] == '2' || bytes_[1] == '5';
    at_ = 2;
    const std::uint32_t width = number(1, 1U << 30), height = number(1, 1U << 30);
    const std::uint32_t most = number(1, 65535);
    const std::uint64_t pixels = std::uint64_t{width} * height;
    if (pixels > kMaxTexturePixels)
      throw Error(ErrorKind::limit, name_, "has more than 2^28 pixels");
    const std::size_t count = static_cast<std::size_t>(pixels) * (is_gray ? 1 : 3),
                      size = most < 256 ? 1 : 2;
    // Exactly one white-space character separates the header from binary samples.
    if (!is_text && (++at_ > bytes_.size() || (bytes_.size() - at_) / size < count))
      fail("ends early");
    if (is_text && (bytes_.size() - at_) / 2 < count - 1) fail("ends early");
    take_memory(count * size, "the pixels of a picture");
    Image image{.width = width, .height = height, .channels = is_gray ? 1U : 3U};
    const auto sample = [&]() -> std::uint32_t {
      if (is_text) return number(0, most);
      std::uint32_t value = static_cast<unsigned char>(bytes_[at_++]);
      if (size == 2) value = value << 8U | static_cast<unsigned char>(bytes_[at_++]);
      if (value > most) fail("has a sample above its maximum");
      return value;
    };
    const auto fill = [&](auto& samples, std::uint32_t scale) {
      samples.resize(count);
      for (auto& value : samples) {
        using Sample = std::remove_reference_t<decltype(value)>;
        value = static_cast<Sample>((std::uint64_t{sample()} * scale + most / 2) / most);
      }
    };
    if (size == 1)
      fill(image.samples.emplace<std::vector<std::uint8_t>>(), 255);
    else
      fill(image.samples.emplace<std::vector<std::uint16_t>>(), 65535);
    require_end(is_text);
    return image;
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const {
    throw Error(ErrorKind::io, name_, "is a damaged PGM or PPM file: it " + problem);
  }

  /// Binary files may contain several pictures one after the other, text files may not.
  void require_end(bool is_text) {
    skip_space();
    if (at_ >= bytes_.size()) return;
    if (is_text) fail("has further text after its samples");
    throw Error(ErrorKind::unsupported, name_,
                "has further data after its picture, such as a next frame or padding; store each "
                "picture in a file of its own");
  }

  void skip_space() {
    while (at_ < bytes_.size()) {
      if (bytes_[at_] == '#') {
        at_ = std::min(bytes_.find('\n', at_), bytes_.size());
      } else if (std::string_view(" \t\r\n\v\f").find(bytes_[at_]) == std::string_view::npos) {
        return;
      } else {
        ++at_;
      }
    }
  }

  std::uint32_t number(std::uint32_t least, std::uint32_t most) {
    skip_space();
    const std::size_t start = at_;
    std::uint64_t value = 0;
    for (; at_ < bytes_.size() && bytes_[at_] >= '0' && bytes_[at_] <= '9'; ++at_) {
      value = value * 10 + static_cast<std::uint64_t>(bytes_[at_] - '0');
      if (value > most) fail("has a number above " + std::to_string(most));
    }
    if (at_ == start) fail(at_ == bytes_.size() ? "ends early" : "lacks a number");
    if (value < least) fail("has a number below " + std::to_string(least));
    return static_cast<std::uint32_t>(value);
  }

  std::string_view bytes_;
  const std::string& name_;
  std::size_t at_ = 0;
};

}  // namespace

bool is_ppm(std::string_view bytes) {
  return bytes.size() >= 2 && bytes[0] == 'P' &&
         std::string_view("2356").find(bytes[1]) != std::string_view::npos;
}

Image decode_ppm(std::string_view bytes, const std::string& name) {
  return PpmReader(bytes, name).read();
}

}  // namespace microtrace::io
