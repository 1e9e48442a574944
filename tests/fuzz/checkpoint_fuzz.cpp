// The libFuzzer entry point for checkpoints. Reads, merges and renders files with arbitrary content
// and a valid digest.

#include <microtrace/checkpoint.hpp>
#include <microtrace/digest.hpp>
#include <microtrace/error.hpp>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <string>
#include <string_view>
#include <sys/mman.h>
#include <unistd.h>

namespace {

void expect(bool promise, const char* words) {
  if (promise) return;
  std::cerr << "broken promise: " << words << '\n';
  std::abort();
}

/// A file in memory.
class MemoryFile {
 public:
  explicit MemoryFile(std::string_view bytes) : descriptor_(memfd_create("checkpoint", 0)) {
    expect(write(descriptor_, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()),
           "memory can be written");
  }
  ~MemoryFile() { close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  [[nodiscard]] std::filesystem::path path() const {
    return "/proc/self/fd/" + std::to_string(descriptor_);
  }

 private:
  int descriptor_;
};

std::string with_digest(std::string_view content) {
  microtrace::Digest digest;
  digest.add(content);
  std::string bytes(content);
  for (unsigned shift = 0; shift < 64; shift += 8)
    bytes += static_cast<char>(digest.value() >> shift & 0xFFU);
  return bytes;
}

}  // namespace

// libFuzzer defines the name and the types.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace microtrace;
  const MemoryFile file(with_digest({reinterpret_cast<const char*>(data), size}));
  try {
    Checkpoint all = load_checkpoint(file.path());
    static_cast<void>(picture_of(all));
    const std::uint32_t count = all.sums.count();
    add_samples(all, load_checkpoint(file.path()), file.path());
    expect(count == 0 && all.sums.count() == 0, "no sample is counted twice");
  } catch (const Error& error) {
    expect(error.kind() == ErrorKind::usage || error.kind() == ErrorKind::io,
           "invalid checkpoints are refused");
    expect(!error.diagnostic().message.empty(), "every error has a message");
  }
  return 0;
}
