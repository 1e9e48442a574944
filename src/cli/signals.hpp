#pragma once
/// What ends the program before its work is done.

namespace microtrace::cli {

/// Makes interrupts, hang-ups and the like end the process with 128 + the signal's number and no
/// temporary file; those that the process was started to ignore (nohup, jobs in the background)
/// stay ignored. Writing to closed pipes and beyond size limits become errors of the write.
void handle_signals();

/// After so many seconds from now the process ends with ErrorKind::limit, a message and no
/// temporary file, whatever it does then.
void end_after(double seconds);

}  // namespace microtrace::cli
