#pragma once
/// The list of existing temporary files, which remove_unfinished_files() of <microtrace/io.hpp>
/// removes in a signal handler.

namespace microtrace::io {

/// Lists a path before its file is created. Returns its slot, or -1 if the list is full or the path
/// too long; then only the AtomicFile's destructor removes the file.
[[nodiscard]] int note_unfinished_file(const char* path) noexcept;

/// Frees a slot; -1 is ignored.
void forget_unfinished_file(int slot) noexcept;

}  // namespace microtrace::io
