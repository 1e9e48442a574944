#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>

/// The size of a mesh in the header of Draco's data, for checks before memory is allocated.
struct DracoHeader {
  std::uint64_t triangles = 0;
  std::uint64_t points = 0;  ///< at least; the edgebreaker format stores a lower number
};

/// Nothing if the bytes are not a mesh of Draco bitstream version 2.2, which glTF requires.
[[nodiscard]] std::optional<DracoHeader> read_draco_header(const char* bytes, std::size_t size);
