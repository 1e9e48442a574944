#include "io/unfinished_files.hpp"

#include <microtrace/io.hpp>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <unistd.h>

namespace microtrace {
namespace {

enum class State { free, filling, listed };

struct Slot {
  std::atomic<State> state{State::free};
  std::array<char, 4096> path{};
};

static_assert(std::atomic<State>::is_always_lock_free, "a signal handler reads it");

// Static, because a signal handler can't use other kinds of storage safely.
std::array<Slot, 8> slots;

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
    if (slot.state == State::listed) ::unlink(slot.path.data());
  }
  errno = saved;
}

}  // namespace microtrace
