#pragma once
/// Text entries that describe a picture in its file.

#include <microtrace/film.hpp>

#include <string>
#include <vector>

namespace microtrace::io {

struct Note {
  std::string name, text;
};

/// Notes about the display transforms that were requested, if any. If the format stores linear
/// light, the note says that none was applied.
[[nodiscard]] std::vector<Note> notes_of(const Display& display, bool holds_light);

}  // namespace microtrace::io
