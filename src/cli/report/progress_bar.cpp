#include "cli/report/progress_bar.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <sys/ioctl.h>
#include <unistd.h>

namespace microtrace::cli {
namespace {

using Clock = std::chrono::steady_clock;

bool can_draw() {
  const char* terminal = std::getenv("TERM");
  return isatty(STDERR_FILENO) == 1 && terminal != nullptr && std::string_view(terminal) != "dumb";
}

/// A job in the background would write over what the user types.
bool is_in_background() {
  const pid_t group = ::tcgetpgrp(STDERR_FILENO);
  return group > 0 && group != ::getpgrp();
}

/// Returns the length of the terminal's lines.
std::size_t columns() {
  winsize size{};
  const bool is_known = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return is_known ? size.ws_col : 80;
}

/// Returns a line that is shorter than those of the terminal, which would wrap longer ones.
std::string line_of(double fraction, double seconds, std::uint32_t pictures, std::size_t columns) {
  std::string text = std::to_string(static_cast<int>(fraction * 100)) + " %";
  text.insert(0, std::max(text.size(), std::size_t{5}) - text.size(), ' ');
  if (fraction > 0) {
    const double left = std::round(seconds / fraction * (1 - fraction));
    text += ", " + std::to_string(static_cast<std::int64_t>(std::min(left, 1e9))) + " s left";
  }
  if (pictures > 1) {
    const auto picture = static_cast<std::uint32_t>(fraction * pictures) + 1;
    text += ", picture " + std::to_string(picture) + " of " + std::to_string(pictures);
  }
  constexpr std::size_t kWidest = 40, kNarrowest = 4, kFrame = 3;
  const std::size_t most = std::max(columns, std::size_t{2}) - 1;
  if (text.size() + kFrame + kNarrowest > most) return text.substr(0, most);
  const std::size_t width = std::min(kWidest, most - kFrame - text.size());
  const auto filled = static_cast<std::size_t>(fraction * static_cast<double>(width));
  return "[" + std::string(filled, '#') + std::string(width - filled, '.') + "] " + text;
}

// RISC-V has no instruction to exchange a single byte.
std::atomic<int> is_drawn = 0;

}  // namespace

void clear_progress_bar() {
  constexpr std::string_view kClear = "\r\x1b[K";
  if (is_drawn.exchange(0) == 0) return;
  const ssize_t ignored = ::write(STDERR_FILENO, kClear.data(), kClear.size());
  static_cast<void>(ignored);
}

std::function<void(double)> progress_bar(std::uint32_t pictures) {
  if (!can_draw()) return {};
  return [pictures, start = Clock::now(), last = Clock::time_point()](double fraction) mutable {
    using namespace std::chrono_literals;
    const Clock::time_point now = Clock::now();
    if (fraction >= 1) {
      clear_progress_bar();
    } else if (now - start > 500ms && now - last > 100ms) {
      last = now;
      if (is_in_background()) return;
      const double seconds = std::chrono::duration<double>(now - start).count();
      const std::string line = line_of(fraction, seconds, pictures, columns());
      std::fprintf(stderr, "\r%s\x1b[K", line.c_str());
      is_drawn = 1;
    }
  };
}

std::function<void(double)> progress_lines() {
  return [start = Clock::now(), last = Clock::time_point()](double fraction) mutable {
    using namespace std::chrono_literals;
    const Clock::time_point now = Clock::now();
    if (fraction < 1 && now - last < 100ms) return;
    last = now;
    std::fprintf(stderr, "{\"progress\": %.4f, \"seconds\": %.3f}\n", fraction,
                 std::chrono::duration<double>(now - start).count());
  };
}

}  // namespace microtrace::cli
