#pragma once
/// The temporaries that exist now, for a signal handler to remove: remove_unfinished_files() of
/// <microtrace/io.hpp> reads this list.

namespace microtrace::io {

/// Lists a path, before the file is made. Returns its slot, or -1 if the list is full or the path
/// too long: the file is then removed by its destructor alone.
[[nodiscard]] int note_unfinished_file(const char* path) noexcept;

/// Frees a slot; -1 is ignored.
void forget_unfinished_file(int slot) noexcept;

}  // namespace microtrace::io
