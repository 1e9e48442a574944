#include "io/gltf/bytes/container.hpp"

#include <microtrace/error.hpp>

#include <cstddef>
#include <cstdint>

namespace microtrace::io::gltf {
namespace {

constexpr std::uint32_t kJsonType = 0x4E4F534A;  // "JSON"
constexpr std::uint32_t kBinType = 0x004E4942;   // "BIN\0"
constexpr std::size_t kHeaderSize = 12, kChunkHeaderSize = 8;

std::uint32_t read_u32(std::string_view bytes, std::size_t offset) {
  std::uint32_t value = 0;
  for (std::size_t i = 4; i-- > 0;) {
    value = value << 8U | static_cast<unsigned char>(bytes[offset + i]);
  }
  return value;
}

struct Chunk {
  std::uint32_t type;
  std::string_view data;
};

class ChunkReader {
 public:
  ChunkReader(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  [[nodiscard]] bool at_end() const { return offset_ == bytes_.size(); }

  Chunk next() {
    const std::size_t left = bytes_.size() - offset_;
    if (left < kChunkHeaderSize) fail(where() + "ends within the chunk's header");
    const std::uint32_t length = read_u32(bytes_, offset_);
    const std::uint32_t type = read_u32(bytes_, offset_ + 4);
    is_aligned_ = is_aligned_ && length % 4 == 0;
    if (length > left - kChunkHeaderSize) {
      fail(where() + "states " + std::to_string(length) + " bytes, but only " +
           std::to_string(left - kChunkHeaderSize) + " follow");
    }
    const std::string_view data = bytes_.substr(offset_ + kChunkHeaderSize, length);
    offset_ += kChunkHeaderSize + length;
    ++number_;
    return {type, data};
  }

  /// Returns true if the lengths of all chunks so far are multiples of 4, as glTF requires.
  [[nodiscard]] bool is_aligned() const { return is_aligned_; }

  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorKind::invalid_scene, name_, "GLB file: " + what + "; export it again");
  }

 private:
  [[nodiscard]] std::string where() const {
    return "chunk " + std::to_string(number_) + " at byte " + std::to_string(offset_) + " ";
  }

  std::string_view bytes_;
  const std::string& name_;
  std::size_t offset_ = kHeaderSize;
  std::size_t number_ = 0;
  bool is_aligned_ = true;
};

void check_header(std::string_view bytes, const std::string& name) {
  if (bytes.size() < kHeaderSize + kChunkHeaderSize) {
    throw Error(ErrorKind::invalid_scene, name,
                "GLB file is truncated: a header and a chunk take 20 bytes, the file has " +
                    std::to_string(bytes.size()));
  }
  if (const std::uint32_t version = read_u32(bytes, 4); version != 2) {
    throw Error(ErrorKind::unsupported, name,
                "GLB container version is " + std::to_string(version) +
                    ", but only 2 is supported; export the file as glTF 2.0");
  }
  const std::uint32_t length = read_u32(bytes, 8);
  if (length < kHeaderSize + kChunkHeaderSize) {
    throw Error(ErrorKind::invalid_scene, name,
                "GLB header states " + std::to_string(length) +
                    " bytes, less than a header and a chunk take; export it again");
  }
  if (length > bytes.size()) {
    throw Error(ErrorKind::invalid_scene, name,
                "GLB header states " + std::to_string(length) + " bytes, the file has " +
                    std::to_string(bytes.size()) + "; it is truncated");
  }
}

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

}  // namespace

Container open_container(std::string_view bytes, const std::string& name) {
  if (!bytes.starts_with("glTF")) {
    return {.json = bytes, .bin = {}, .has_byte_order_mark = bytes.starts_with(kByteOrderMark)};
  }
  check_header(bytes, name);
  const std::size_t size = bytes.size();
  bytes = bytes.substr(0, read_u32(bytes, 8));
  ChunkReader reader(bytes, name);
  const Chunk first = reader.next();
  if (first.type != kJsonType) reader.fail("the first chunk is not JSON");
  if (first.data.empty()) reader.fail("the JSON chunk is empty");
  Container result{.json = first.data,
                   .bin = {},
                   .is_glb = true,
                   .has_byte_order_mark = first.data.starts_with(kByteOrderMark),
                   .extra_bytes = size - bytes.size()};
  for (bool second = true; !reader.at_end(); second = false) {
    const Chunk chunk = reader.next();
    if (chunk.type == kJsonType) reader.fail("there are two JSON chunks");
    if (chunk.type == kBinType && !second) reader.fail("a BIN chunk is not the second");
    if (chunk.type == kBinType) result.bin = chunk.data;
  }
  result.is_aligned = reader.is_aligned();
  const std::size_t end = result.json.find_last_not_of('\0');
  if (end != std::string_view::npos && end + 1 < result.json.size()) {
    result.json = result.json.substr(0, end + 1);
    result.has_zero_padding = true;
  }
  return result;
}

}  // namespace microtrace::io::gltf
