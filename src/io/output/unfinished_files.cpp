#include "io/output/unfinished_files.hpp"

#include <microtrace/io.hpp>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <dirent.h>
#include <fcntl.h>
#include <sys/types.h>
#include <unistd.h>

namespace microtrace {
namespace {

enum class State { free, filling, listed };

struct Slot {
  std::atomic<State> state{State::free};
  std::array<char, 4096> path{};
};

static_assert(std::atomic<State>::is_always_lock_free, "a signal handler reads it");

/// The greatest depth of folders in a temporary folder, which bounds the stack of a signal handler.
constexpr int kMostLevels = 16;

// Static, because a signal handler can't use other kinds of storage safely.
std::array<Slot, 8> slots;

/// Removes a file, or a folder with all that it contains, by calls that are safe in a signal
/// handler. Other threads may still create files in it, so it tries several times.
void remove_all(int parent, const char* name, int levels) noexcept {
  constexpr int kTries = 8;
  for (int i = 0; i < kTries; ++i) {
    if (::unlinkat(parent, name, 0) == 0 || errno != EISDIR) return;
    if (::unlinkat(parent, name, AT_REMOVEDIR) == 0 || levels == 0) return;
    const int folder = ::openat(parent, name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (folder < 0) return;
    alignas(dirent64) std::array<char, 2048> entries;
    for (ssize_t size = 0; (size = ::getdents64(folder, entries.data(), entries.size())) > 0;) {
      for (ssize_t at = 0; at < size;) {
        const auto* entry =
            reinterpret_cast<const dirent64*>(&entries[static_cast<std::size_t>(at)]);
        const bool is_itself = std::strcmp(entry->d_name, ".") == 0;
        if (!is_itself && std::strcmp(entry->d_name, "..") != 0)
          remove_all(folder, entry->d_name, levels - 1);
        at += entry->d_reclen;
      }
    }
    ::close(folder);
  }
}

}  // namespace

namespace io {

int note_unfinished_file(const char* path) noexcept {
  const std::size_t size = std::strlen(path) + 1;
  if (size > slots[0].path.size()) return -1;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    State expected = State::free;
    if (!slots[i].state.compare_exchange_strong(expected, State::filling)) continue;
    std::memcpy(slots[i].path.data(), path, size);
    slots[i].state = State::listed;
    return static_cast<int>(i);
  }
  return -1;
}

void forget_unfinished_file(int slot) noexcept {
  if (slot >= 0) slots[static_cast<std::size_t>(slot)].state = State::free;
}

}  // namespace io

void remove_unfinished_files() noexcept {
  const int saved = errno;
  for (const Slot& slot : slots) {
    if (slot.state == State::listed) remove_all(AT_FDCWD, slot.path.data(), kMostLevels);
  }
  errno = saved;
}

}  // namespace microtrace
