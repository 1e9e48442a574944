// The libFuzzer entry point for glTF. Inputs may be JSON text or GLB files. A third form is easier
// to mutate: JSON text, a zero byte, and the binary chunk. It is converted to a GLB file with valid
// lengths.

#include "read_and_draw.hpp"

#include <cstdint>
#include <string>

namespace {

std::string number(std::uint32_t n) {
  std::string bytes;
  for (int k = 0; k < 4; ++k) bytes += static_cast<char>(n >> (8 * k) & 0xFFU);
  return bytes;
}

std::string chunk(const char* type, std::string_view data, char filler) {
  std::string padded(data);
  while (padded.size() % 4 != 0) padded += filler;
  return number(static_cast<std::uint32_t>(padded.size())) + std::string(type, 4) + padded;
}

std::string glb(std::string_view json, std::string_view binary) {
  const std::string chunks = chunk("JSON", json, ' ') + chunk("BIN\0", binary, '\0');
  return "glTF" + number(2) + number(static_cast<std::uint32_t>(chunks.size()) + 12) + chunks;
}

}  // namespace

// libFuzzer defines the name and the types.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using microtrace::fuzz::read_and_draw;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const std::size_t zero = bytes.find('\0');
  if (bytes.starts_with("glTF"))
    read_and_draw(bytes, "fuzz.glb");
  else if (zero != std::string_view::npos)
    read_and_draw(glb(bytes.substr(0, zero), bytes.substr(zero + 1)), "fuzz.glb");
  else
    read_and_draw(bytes, "fuzz.gltf");
  return 0;
}
