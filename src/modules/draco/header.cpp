#include "modules/draco/header.hpp"

#include <cstring>
#include <draco/core/decoder_buffer.h>
#include <draco/core/varint_decoding.h>
#include <draco/metadata/metadata_decoder.h>

namespace {

constexpr std::uint8_t kMesh = 1, kSequential = 0, kEdgebreaker = 1;
constexpr std::uint16_t kHasMetadata = 0x8000;

struct Start {
  char magic[5];
  std::uint8_t major, minor, geometry, method;
};

}  // namespace

std::optional<DracoHeader> read_draco_header(const char* bytes, std::size_t size) {
  draco::DecoderBuffer buffer;
  buffer.Init(bytes, size);
  buffer.set_bitstream_version(DRACO_BITSTREAM_VERSION(2, 2));
  Start start;
  std::uint16_t flags = 0;
  if (!buffer.Decode(&start, sizeof start) || !buffer.Decode(&flags)) return std::nullopt;
  if (std::memcmp(start.magic, "DRACO", 5) != 0 || start.major != 2 || start.minor != 2 ||
      start.geometry != kMesh)
    return std::nullopt;
  if ((flags & kHasMetadata) != 0) {
    draco::GeometryMetadata metadata;
    if (!draco::MetadataDecoder().DecodeGeometryMetadata(&buffer, &metadata)) return std::nullopt;
  }
  std::uint32_t faces = 0, points = 0;
  if (start.method == kSequential) {
    if (!draco::DecodeVarint(&faces, &buffer) || !draco::DecodeVarint(&points, &buffer))
      return std::nullopt;
  } else if (start.method == kEdgebreaker) {
    std::uint8_t traversal = 0;
    if (!buffer.Decode(&traversal) || !draco::DecodeVarint(&points, &buffer) ||
        !draco::DecodeVarint(&faces, &buffer))
      return std::nullopt;
  } else {
    return std::nullopt;
  }
  return DracoHeader{.triangles = faces, .points = points};
}
