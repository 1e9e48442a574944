#pragma once
/// Keeps a list of the temporary files and folders that currently exist. remove_unfinished_files()
/// in <microtrace/io.hpp> deletes them and may be called by a signal handler.

namespace microtrace::io {

/// Adds a path to the list before its file is created, or after its folder is. Returns its slot, or
/// -1 if the list is full or the path is too long. If it returns -1, only the destructor of the
/// AtomicFile or TemporaryFolder removes it.
[[nodiscard]] int note_unfinished_file(const char* path) noexcept;

/// Frees a slot. Ignores -1.
void forget_unfinished_file(int slot) noexcept;

}  // namespace microtrace::io
