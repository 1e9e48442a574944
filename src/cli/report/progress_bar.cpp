#include "cli/report/progress_bar.hpp"

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <unistd.h>

namespace microtrace::cli {
namespace {

using Clock = std::chrono::steady_clock;

bool can_draw() {
  const char* terminal = std::getenv("TERM");
  return isatty(STDERR_FILENO) == 1 && terminal != nullptr && std::string_view(terminal) != "dumb";
}

void draw(double fraction, double seconds, std::uint32_t pictures) {
  constexpr int kWidth = 40;
  const int filled = static_cast<int>(fraction * kWidth);
  const std::string bar = std::string(static_cast<std::size_t>(filled), '#') +
                          std::string(static_cast<std::size_t>(kWidth - filled), '.');
  std::fprintf(stderr, "\r[%s] %3d %%", bar.c_str(), static_cast<int>(fraction * 100));
  if (fraction > 0) std::fprintf(stderr, ", %.0f s left", seconds / fraction * (1 - fraction));
  if (pictures > 1) {
    const int picture = static_cast<int>(fraction * pictures) + 1;
    std::fprintf(stderr, ", picture %d of %u", picture, pictures);
  }
  std::fputs("\x1b[K", stderr);
}

std::atomic<bool> is_drawn = false;

}  // namespace

void clear_progress_bar() {
  constexpr std::string_view kClear = "\r\x1b[K";
  if (!is_drawn.exchange(false)) return;
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
      draw(fraction, std::chrono::duration<double>(now - start).count(), pictures);
      last = now;
      is_drawn = true;
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
