#include "io/npz/zip_archive.hpp"

#include "base/crc32.hpp"
#include "base/memory_account.hpp"
#include "base/text/printable.hpp"
#include "io/checkpoint/bytes.hpp"
#include "io/file.hpp"
#include "io/image/codec_abi.hpp"
#include "io/module_function.hpp"

#include <microtrace/error.hpp>

#include <algorithm>
#include <utility>

namespace microtrace::io {
namespace {

constexpr std::string_view kHeader("PK\3\4", 4), kDirectory("PK\1\2", 4), kEnd("PK\5\6", 4);
constexpr std::size_t kHeaderSize = 30, kEndSize = 22;
constexpr std::uint32_t kStored = 0, kDeflated = 8;
constexpr std::uint16_t kEncrypted = 1;

/// Deflate (RFC 1951) compresses at most 258 bytes to two bits.
constexpr std::size_t kMaxRatio = std::size_t{4} * 258;

std::uint32_t word(ByteReader& reader) {
  return reader.number<std::uint32_t>();
}

std::uint16_t half(ByteReader& reader) {
  return reader.number<std::uint16_t>();
}

}  // namespace

void ZipArchive::fail_as_damaged() const {
  throw Error(ErrorKind::io, file_,
              "is not a whole ZIP archive of less than 4 GiB; write it again with numpy.savez");
}

ZipArchive::ZipArchive(std::string_view bytes, std::string file)
    : bytes_(bytes), file_(std::move(file)) {
  const std::size_t end = bytes.rfind(kEnd);
  if (end == bytes.npos || bytes.size() - end < kEndSize) fail_as_damaged();
  ByteReader tail(bytes.substr(end + kEnd.size()));
  const std::uint16_t disk = half(tail), first_disk = half(tail);
  const std::uint16_t here = half(tail), count = half(tail);
  const std::size_t size = word(tail), start = word(tail);
  const bool is_split = disk != 0 || first_disk != 0;
  if (is_split || here != count || start > end || size > end - start) fail_as_damaged();
  ByteReader directory(bytes.substr(start, size));
  for (std::uint16_t i = 0; i < count; ++i) {
    if (directory.take(kDirectory.size()) != kDirectory) fail_as_damaged();
    Entry entry;
    (void)word(directory);  // versions
    const std::uint16_t flags = half(directory);
    entry.method = half(directory);
    (void)word(directory);  // time
    entry.checksum = word(directory);
    entry.compressed = word(directory);
    entry.size = word(directory);
    const std::uint16_t name = half(directory), extra = half(directory), comment = half(directory);
    (void)directory.take(8);  // disk, attributes
    entry.header = word(directory);
    const auto text = directory.take(name);
    const bool is_whole = directory.take(std::size_t{extra} + comment).has_value();
    if (!text || !is_whole || directory.is_short()) fail_as_damaged();
    entry.name = *text;
    if ((flags & kEncrypted) != 0) {
      throw Error(ErrorKind::unsupported, file_,
                  printable(entry.name) + " is encrypted; write it without a password");
    }
    entries_.push_back(std::move(entry));
  }
}

std::string ZipArchive::content(const Entry& entry) const {
  ByteReader header(bytes_.substr(std::min(entry.header, bytes_.size())));
  if (header.take(kHeader.size()) != kHeader) fail_as_damaged();
  (void)header.take(kHeaderSize - kHeader.size() - 4);
  const std::uint16_t name = half(header), extra = half(header);
  (void)header.take(std::size_t{name} + extra);
  const auto packed = header.take(entry.compressed);
  if (!packed || header.is_short()) fail_as_damaged();
  if (entry.method != kStored && entry.method != kDeflated) {
    throw Error(ErrorKind::unsupported, file_,
                printable(entry.name) +
                    " is compressed by a method other than deflate; write it "
                    "with numpy.savez or numpy.savez_compressed");
  }
  if (entry.size > kMaxFileSize) {
    throw Error(ErrorKind::limit, file_,
                printable(entry.name) + " is larger than " + std::to_string(kMaxFileSize) +
                    " bytes, the limit; split it");
  }
  // Refuses a small file that claims a large content before it allocates memory for it.
  const bool is_possible = entry.method == kStored ? entry.size == entry.compressed
                                                   : entry.size / kMaxRatio <= entry.compressed;
  if (!is_possible) fail_as_damaged();
  take_memory(entry.size, "the content of " + file_);
  std::string content(*packed);
  if (entry.method == kDeflated) {
    const ModuleFunction function = find_module_function(kCodecModuleFileName, kInflateName);
    if (function.address == nullptr) {
      throw Error(ErrorKind::unsupported, file_,
                  "is compressed and can't be read: " + function.complaint +
                      "; write it with numpy.savez, which doesn't compress");
    }
    content.resize(entry.size);
    const auto inflate = reinterpret_cast<MicrotraceDecompress>(function.address);
    if (inflate(content.data(), content.size(), packed->data(), packed->size()) != 1)
      fail_as_damaged();
  }
  if (crc32(content) != entry.checksum) fail_as_damaged();
  return content;
}

}  // namespace microtrace::io
