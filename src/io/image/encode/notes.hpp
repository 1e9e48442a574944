#pragma once
/// Text entries that describe a picture in its file.

#include <microtrace/film.hpp>

#include <string>
#include <vector>

namespace microtrace::io {

struct Note {
  std::string name, text;
};

/// The display transforms applied to the colors, if any were requested. For formats that store
/// linear light the note says that none was applied.
[[nodiscard]] std::vector<Note> notes_of(const Display& display, bool holds_light);

}  // namespace microtrace::io
