#include "cli/view/browser.hpp"

#include <array>
#include <cstdlib>
#include <fcntl.h>
#include <spawn.h>
#include <unistd.h>

namespace microtrace::cli {
namespace {

bool is_set(const char* variable) {
  const char* value = std::getenv(variable);
  return value != nullptr && *value != 0;
}

}  // namespace

void open_browser(const std::string& address) {
  // BROWSER is also set by remote sessions of editors, whose command opens the local browser.
  const char* named = std::getenv("BROWSER");
  const bool has_named = is_set("BROWSER");
  if (!has_named && !is_set("DISPLAY") && !is_set("WAYLAND_DISPLAY")) return;
  std::string program = has_named ? named : "xdg-open", argument = address;
  posix_spawn_file_actions_t actions;
  if (::posix_spawn_file_actions_init(&actions) != 0) return;
  // Messages of browsers would mix with those of the program.
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    ::posix_spawn_file_actions_addopen(&actions, descriptor, "/dev/null", O_RDWR, 0);
  std::array<char*, 3> words{program.data(), argument.data(), nullptr};
  pid_t child = 0;
  static_cast<void>(
      ::posix_spawnp(&child, program.c_str(), &actions, nullptr, words.data(), environ));
  ::posix_spawn_file_actions_destroy(&actions);
}

}  // namespace microtrace::cli
