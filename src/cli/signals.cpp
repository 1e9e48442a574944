#include "cli/signals.hpp"

#include <microtrace/error.hpp>
#include <microtrace/io.hpp>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstring>
#include <sys/time.h>
#include <unistd.h>

namespace microtrace::cli {
namespace {

// These signal handlers make only async-signal-safe calls.

void end_at_once(int signal) {
  remove_unfinished_files();
  _exit(128 + signal);
}

void end_at_limit(int /*signal*/) {
  constexpr char kMessage[] = "error: --max-time has elapsed; nothing more is written\n";
  remove_unfinished_files();
  const ssize_t ignored = ::write(STDERR_FILENO, kMessage, sizeof kMessage - 1);
  static_cast<void>(ignored);
  _exit(static_cast<int>(ErrorKind::limit));
}

void handle(int signal, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  ::sigfillset(&action.sa_mask);
  ::sigaction(signal, &action, nullptr);
}

bool is_ignored(int signal) {
  struct sigaction action {};
  return ::sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

}  // namespace

void handle_signals() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGXCPU}) {
    if (!is_ignored(signal)) handle(signal, end_at_once);
  }
  handle(SIGPIPE, SIG_IGN);
  handle(SIGXFSZ, SIG_IGN);
}

void end_after(double seconds) {
  // kMost is below the greatest time that the kernel's timer accepts. A time of 0 would disable the
  // timer.
  constexpr double kMost = 1e8, kLeast = 1e-6;
  const double time = std::clamp(seconds, kLeast, kMost);
  handle(SIGALRM, end_at_limit);
  sigset_t alarm;
  ::sigemptyset(&alarm);
  ::sigaddset(&alarm, SIGALRM);
  ::pthread_sigmask(SIG_UNBLOCK, &alarm, nullptr);
  itimerval timer{};
  timer.it_value.tv_sec = static_cast<time_t>(time);
  timer.it_value.tv_usec =
      static_cast<suseconds_t>(std::min((time - std::floor(time)) * 1e6, 999999.0));
  ::setitimer(ITIMER_REAL, &timer, nullptr);
}

}  // namespace microtrace::cli
