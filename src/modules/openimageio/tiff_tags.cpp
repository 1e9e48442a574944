#include "modules/openimageio/tiff_tags.hpp"

namespace {

/// The bytes of a file, in its own order.
class TiffBytes {
 public:
  explicit TiffBytes(std::string_view file) : file_(file), is_big_endian_(file.starts_with("MM")) {}

  /// Returns the number in these bytes; 0 beyond the end.
  [[nodiscard]] std::uint64_t number(std::uint64_t at, std::size_t size) const {
    if (at > file_.size() || file_.size() - at < size) return 0;
    std::uint64_t result = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t byte = at + (is_big_endian_ ? i : size - 1 - i);
      result = result << 8U | static_cast<unsigned char>(file_[byte]);
    }
    return result;
  }

 private:
  std::string_view file_;
  bool is_big_endian_;
};

}  // namespace

std::optional<std::uint32_t> short_of_tiff(std::string_view file, std::uint32_t tag) {
  const TiffBytes bytes(file);
  // A BigTIFF file has the version 43.
  const bool is_big = bytes.number(2, 2) == 43;
  const std::uint64_t directory = is_big ? bytes.number(8, 8) : bytes.number(4, 4);
  const std::size_t count_size = is_big ? 8 : 2, entry_size = is_big ? 20 : 12;
  const std::uint64_t count = bytes.number(directory, count_size);
  if (count > file.size() / entry_size) return std::nullopt;
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::uint64_t entry = directory + count_size + i * entry_size;
    if (bytes.number(entry, 2) == tag)
      return static_cast<std::uint32_t>(bytes.number(entry + (is_big ? 12 : 8), 2));
  }
  return std::nullopt;
}
