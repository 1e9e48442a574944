#pragma once
/// Reads ZIP archives of less than 4 GiB, stored or compressed by deflate, as NumPy writes them
/// (PKWARE, APPNOTE.TXT, version 6.3.10).

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace microtrace::io {

class ZipArchive {
 public:
  struct Entry {
    std::string name;
    std::uint32_t method = 0, checksum = 0;
    std::size_t compressed = 0, size = 0;  ///< bytes
    std::size_t header = 0;                ///< position of the header before the content
  };

  /// Reads the archive's directory. `bytes` must outlive this object. `file` is its name, for
  /// messages. Throws Error (io) if the archive is damaged.
  ZipArchive(std::string_view bytes, std::string file);

  [[nodiscard]] const std::vector<Entry>& entries() const { return entries_; }

  /// Returns the content of an entry. Throws Error: io if it is damaged; unsupported if it is
  /// encrypted or compressed in another way, or if the module that decompresses it is missing;
  /// limit if it is larger than kMaxFileSize.
  [[nodiscard]] std::string content(const Entry& entry) const;

 private:
  [[noreturn]] void fail_as_damaged() const;

  std::string_view bytes_;
  std::string file_;
  std::vector<Entry> entries_;
};

}  // namespace microtrace::io
