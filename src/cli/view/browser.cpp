#include "cli/view/browser.hpp"

#include <array>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <spawn.h>
#include <unistd.h>

namespace microtrace::cli {
namespace {

/// Returns the value of an environment variable, or null if it is absent or empty.
const char* value_of(const char* variable) {
  const char* value = std::getenv(variable);
  return value != nullptr && *value != 0 ? value : nullptr;
}

}  // namespace

void open_browser(const std::string& address) {
  // BROWSER is also set by remote sessions of editors, whose command opens the local browser.
  const char* named = value_of("BROWSER");
  const bool has_desktop = value_of("DISPLAY") != nullptr || value_of("WAYLAND_DISPLAY") != nullptr;
  if (named == nullptr && !has_desktop) return;
  std::string program = named != nullptr ? named : "xdg-open", argument = address;
  posix_spawn_file_actions_t actions;
  if (::posix_spawn_file_actions_init(&actions) != 0) return;
  // Messages of browsers would mix with those of the program.
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    ::posix_spawn_file_actions_addopen(&actions, descriptor, "/dev/null", O_RDWR, 0);
  posix_spawnattr_t attributes;
  if (::posix_spawnattr_init(&attributes) == 0) {
    // Otherwise, Ctrl-C would also end the browser, and it would ignore the signals that this
    // program ignores.
    sigset_t all;
    ::sigfillset(&all);
    ::posix_spawnattr_setsigdefault(&attributes, &all);
    ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSID | POSIX_SPAWN_SETSIGDEF);
    // Otherwise, the launcher would stay as a zombie. The program has no other children.
    std::signal(SIGCHLD, SIG_IGN);
    std::array<char*, 3> words{program.data(), argument.data(), nullptr};
    pid_t child = 0;
    static_cast<void>(
        ::posix_spawnp(&child, program.c_str(), &actions, &attributes, words.data(), environ));
    ::posix_spawnattr_destroy(&attributes);
  }
  ::posix_spawn_file_actions_destroy(&actions);
}

}  // namespace microtrace::cli
