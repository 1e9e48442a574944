#include "cli/signals.hpp"

#include "base/system/start_threads.hpp"
#include "cli/options/option_value.hpp"
#include "cli/report/progress_bar.hpp"

#include <microtrace/error.hpp>
#include <microtrace/io.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <ctime>
#include <sys/time.h>
#include <unistd.h>
#include <vector>

namespace microtrace::cli {
namespace {

/// The recorded signal, or one of these states. A single variable, because other threads run
/// handlers while the main thread begins or ends a delay.
constexpr int kNotDelaying = 0, kDelaying = -1;
std::atomic<int> delayed_signal{kNotDelaying};
static_assert(std::atomic<int>::is_always_lock_free &&
                  std::atomic<std::int64_t>::is_always_lock_free,
              "signal handlers use them");

// These signal handlers make only async-signal-safe calls.

void end_at_once(int signal) {
  remove_unfinished_files();
  clear_progress_bar();
  _exit(128 + signal);
}

/// Records the signal if signals are delayed and none is recorded. Returns the previous state.
int record(int signal) {
  int state = kDelaying;
  delayed_signal.compare_exchange_strong(state, signal);
  return state;
}

/// Returns true within half a second of the first call. timeout(1) and other parents signal first
/// their child and then its whole group, so that one request arrives twice.
bool belongs_to_first_request() {
  constexpr std::int64_t kMost = 500;
  timespec time{};
  ::clock_gettime(CLOCK_MONOTONIC, &time);
  const std::int64_t now = std::int64_t{time.tv_sec} * 1000 + time.tv_nsec / 1'000'000;
  static std::atomic<std::int64_t> first{-1};
  std::int64_t expected = -1;
  return first.compare_exchange_strong(expected, now) || now - expected <= kMost;
}

void end_soon(int signal) {
  const bool is_same_request = belongs_to_first_request();
  const int before = record(signal);
  // Beyond its limit, the kernel repeats XCPU every second, which may be too short for saving.
  const bool is_repeated = before > 0 && (signal == SIGXCPU || is_same_request);
  if (before != kDelaying && !is_repeated) end_at_once(signal);
}

void end_at_limit(int /*signal*/) {
  constexpr char kMessage[] = "error: --max-time has elapsed; nothing more is written\n";
  remove_unfinished_files();
  clear_progress_bar();
  const ssize_t ignored = ::write(STDERR_FILENO, kMessage, sizeof kMessage - 1);
  static_cast<void>(ignored);
  _exit(static_cast<int>(ErrorKind::limit));
}

void handle(int signal, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  ::sigfillset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  ::sigaction(signal, &action, nullptr);
}

bool is_ignored(int signal) {
  struct sigaction action {};
  return ::sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

}  // namespace

void handle_signals() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGXCPU}) {
    if (!is_ignored(signal)) handle(signal, signal != SIGQUIT ? end_soon : end_at_once);
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

DelayedSignals::DelayedSignals() {
  int state = kNotDelaying;
  delayed_signal.compare_exchange_strong(state, kDelaying);
}

DelayedSignals::~DelayedSignals() {
  int state = kDelaying;
  delayed_signal.compare_exchange_strong(state, kNotDelaying);
}

int DelayedSignals::received() {
  return std::max(delayed_signal.load(), 0);
}

void end_with_parent(std::uint32_t parent) {
  static constexpr useconds_t kInterval = 100'000;
  if (::getppid() == 0)
    refuse_usage(
        "--end-with-parent: the parent is in another PID namespace, so its end can't be noticed; "
        "leave this option out");
  const pid_t first = parent != 0 ? static_cast<pid_t>(parent) : ::getppid();
  const auto is_orphan = [first] { return ::getppid() != first; };
  if (is_orphan()) end_at_once(SIGTERM);
  // The kernel's parent-death signal (PR_SET_PDEATHSIG) would also arrive when the thread of the
  // parent that started this process ends, while the parent lives on.
  sigset_t all, former;
  ::sigfillset(&all);
  ::pthread_sigmask(SIG_SETMASK, &all, &former);
  std::vector<Thread> watcher = start_threads(1, [is_orphan] {
    while (!is_orphan()) ::usleep(kInterval);
    // No second signal: one that ended the parent may have arrived here too.
    if (record(SIGTERM) == kNotDelaying) end_at_once(SIGTERM);
  });
  ::pthread_sigmask(SIG_SETMASK, &former, nullptr);
  if (watcher.empty()) {
    throw Error(ErrorKind::limit, "--end-with-parent",
                "needs a thread, which the system refuses to start; raise the limit on processes");
  }
  watcher.front().detach();
}

}  // namespace microtrace::cli
