#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>

/// The size of a mesh according to the header of Draco's data. It is checked before memory is
/// allocated.
struct DracoHeader {
  std::uint64_t triangles = 0;
  std::uint64_t points = 0;  ///< a lower bound, because edgebreaker data may store a smaller number
};

/// Reads the header. Returns nothing unless the bytes are a mesh in version 2.2 of Draco's
/// bitstream, which glTF requires.
[[nodiscard]] std::optional<DracoHeader> read_draco_header(const char* bytes, std::size_t size);
