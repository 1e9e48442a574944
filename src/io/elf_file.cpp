#include "io/elf_file.hpp"

#include "base/system/descriptor.hpp"
#include "base/system/error_text.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <elf.h>
#include <fcntl.h>
#include <link.h>
#include <sys/stat.h>
#include <unistd.h>
#include <vector>

namespace microtrace::io {
namespace {

using Header = ElfW(Ehdr);
using Segment = ElfW(Phdr);
using Section = ElfW(Shdr);

/// An open file that can be read at any offset.
class File {
 public:
  explicit File(const std::filesystem::path& path)
      : descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {
    struct stat status {};
    if (descriptor_.number() < 0 || ::fstat(descriptor_.number(), &status) != 0) {
      complaint_ = error_text(errno);
    } else if (!S_ISREG(status.st_mode)) {
      complaint_ = "it is not a regular file";
    } else {
      size_ = static_cast<std::uint64_t>(status.st_size);
    }
  }

  [[nodiscard]] const std::string& complaint() const { return complaint_; }

  [[nodiscard]] bool holds(std::uint64_t offset, std::uint64_t size) const {
    return offset <= size_ && size <= size_ - offset;
  }

  /// Reads `items` from this offset. Clears them if the file is too short.
  template <class T>
  void read(std::uint64_t offset, std::vector<T>& items) const {
    const std::size_t size = items.size() * sizeof(T);
    const auto is_read = [&] {
      return static_cast<std::size_t>(::pread(descriptor_.number(), items.data(), size,
                                              static_cast<off_t>(offset))) == size;
    };
    if (!holds(offset, size) || !is_read()) items.clear();
  }

 private:
  Descriptor descriptor_;
  std::uint64_t size_ = 0;
  std::string complaint_;
};

bool is_of_this_machine(const Header& header) {
  constexpr int kWordSize = sizeof(void*) == 8 ? ELFCLASS64 : ELFCLASS32;
  return std::memcmp(header.e_ident, ELFMAG, SELFMAG) == 0 &&
         header.e_ident[EI_CLASS] == kWordSize && header.e_type == ET_DYN &&
         header.e_phentsize == sizeof(Segment) && header.e_shentsize == sizeof(Section);
}

}  // namespace

std::string damage_of_elf_file(const std::filesystem::path& path) {
  const File file(path);
  if (!file.complaint().empty()) return file.complaint();
  std::vector<Header> header(1);
  file.read(0, header);
  if (header.empty() || !is_of_this_machine(header[0])) {
    return "it is not a shared library for this machine";
  }
  // The section table is at the end of the file. If it is complete, the file was not cut off.
  std::vector<Segment> segments(header[0].e_phnum);
  std::vector<Section> sections(header[0].e_shnum);
  file.read(header[0].e_phoff, segments);
  file.read(header[0].e_shoff, sections);
  const auto holds_segment = [&](const Segment& segment) {
    return file.holds(segment.p_offset, segment.p_filesz);
  };
  const auto holds_section = [&](const Section& section) {
    return section.sh_type == SHT_NOBITS || file.holds(section.sh_offset, section.sh_size);
  };
  // In a valid file, only the first section has the type null. More of them mean that the end of
  // the file was overwritten with zeros.
  const auto is_null = [](const Section& section) { return section.sh_type == SHT_NULL; };
  const bool is_whole = !segments.empty() && std::ranges::all_of(segments, holds_segment) &&
                        std::ranges::count_if(sections, is_null) == 1 &&
                        std::ranges::all_of(sections, holds_section);
  return is_whole ? "" : "it is truncated or damaged";
}

}  // namespace microtrace::io
