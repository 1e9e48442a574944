#pragma once
/// Reads little-endian numbers.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace microtrace::io {

/// Reads numbers from the front of a byte string.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

  /// Returns nothing if fewer than `size` bytes are left.
  [[nodiscard]] std::optional<std::string_view> take(std::size_t size) {
    if (bytes_.size() < size) return std::nullopt;
    const std::string_view taken = bytes_.substr(0, size);
    bytes_.remove_prefix(size);
    return taken;
  }

  /// Reads one number. If too few bytes are left, returns 0, and is_short() returns true from then
  /// on.
  template <std::unsigned_integral Number>
  [[nodiscard]] Number number() {
    const auto taken = take(sizeof(Number));
    if (!taken) {
      is_short_ = true;
      return 0;
    }
    Number value = 0;
    for (std::size_t i = sizeof(Number); i-- > 0;) {
      value = static_cast<Number>(static_cast<std::uint64_t>(value) << 8U |
                                  static_cast<unsigned char>((*taken)[i]));
    }
    return value;
  }

  [[nodiscard]] bool is_short() const { return is_short_; }
  [[nodiscard]] std::size_t left() const { return bytes_.size(); }

 private:
  std::string_view bytes_;
  bool is_short_ = false;
};

}  // namespace microtrace::io
