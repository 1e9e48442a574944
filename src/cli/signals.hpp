#pragma once
/// Signal handlers, and the time limit of the whole run.

namespace microtrace::cli {

/// Installs handlers for INT, TERM, HUP, QUIT and XCPU. They remove temporary files and end the
/// process with exit code 128 + the signal's number. Signals that were ignored at the start (nohup,
/// background jobs) stay ignored. Writing to a closed pipe or beyond the file size limit fails
/// instead of raising a signal.
void handle_signals();

/// Arms a timer that removes temporary files, prints a message and ends the process with the exit
/// code of ErrorKind::limit after `seconds`.
void end_after(double seconds);

}  // namespace microtrace::cli
