// The libFuzzer entry point for JSON scenes.

#include "read_and_draw.hpp"

#include <cstdint>

// libFuzzer defines the name and the types.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  microtrace::fuzz::read_and_draw({reinterpret_cast<const char*>(data), size}, "fuzz.json");
  return 0;
}
