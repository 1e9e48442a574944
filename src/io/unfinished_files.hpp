#pragma once
/// Lists the temporary files that exist. A signal handler may call remove_unfinished_files() of
/// <microtrace/io.hpp>, which removes them.

namespace microtrace::io {

/// Adds a path to the list before its file is created. Returns its slot, or -1 if the list is full
/// or the path is too long. If it returns -1, only the AtomicFile's destructor removes the file.
[[nodiscard]] int note_unfinished_file(const char* path) noexcept;

/// Frees a slot. Ignores -1.
void forget_unfinished_file(int slot) noexcept;

}  // namespace microtrace::io
