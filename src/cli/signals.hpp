#pragma once
/// Signals and the time limit of the whole run.

namespace microtrace::cli {

/// Makes INT, TERM, HUP, QUIT and XCPU end the process with exit code 128 + the signal's number and
/// no temporary file; those that were ignored at the start (nohup, background jobs) stay ignored.
/// Writing to closed pipes and beyond file size limits fails instead of raising a signal.
void handle_signals();

/// Ends the process after this time with the exit code of ErrorKind::limit, a message and no
/// temporary file.
void end_after(double seconds);

}  // namespace microtrace::cli
