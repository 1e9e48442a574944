#pragma once
/// Signal handlers, the time limit of the whole run, and its end with the parent process.

#include <cstdint>

namespace microtrace::cli {

/// Installs handlers for INT, TERM, HUP, QUIT and XCPU. They remove temporary files and end the
/// process with exit code 128 + the signal's number. Signals that were ignored at the start (nohup,
/// background jobs) stay ignored. Writing to a closed pipe or beyond the file size limit fails
/// instead of raising a signal.
void handle_signals();

/// During the lifetime of an object of this class, the first INT, TERM, HUP or XCPU is only
/// recorded, so that the program can save its samples before it ends. A second INT, TERM or HUP, at
/// least half a second later, ends the process at once.
class DelayedSignals {
 public:
  DelayedSignals();
  ~DelayedSignals();
  DelayedSignals(const DelayedSignals&) = delete;
  DelayedSignals& operator=(const DelayedSignals&) = delete;

  /// The recorded signal; 0 if there is none.
  [[nodiscard]] static int received();
};

/// Thrown after a delayed signal, when the samples are saved. The exit code is 128 + the signal.
struct Interruption {
  int signal;
};

/// Starts a thread that acts like the first TERM when the parent of this process ends. `parent` is
/// the parent's process id, or 0 for the current parent. Ends the process at once if its parent is
/// another one. Throws Error (limit) if the system refuses to start a thread.
void end_with_parent(std::uint32_t parent);

/// Arms a timer that removes temporary files, prints a message and ends the process with the exit
/// code of ErrorKind::limit after `seconds`.
void end_after(double seconds);

}  // namespace microtrace::cli
