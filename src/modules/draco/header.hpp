#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>

/// What the start of Draco's bytes says of a mesh, before memory is taken for it.
struct DracoHeader {
  std::uint64_t triangles = 0;
  std::uint64_t points = 0;  ///< at least; edgebreaker's bytes tell less than there are
};

/// Nothing if the bytes are no mesh of Draco's bitstream version 2.2, which glTF asks for.
[[nodiscard]] std::optional<DracoHeader> read_draco_header(const char* bytes, std::size_t size);
