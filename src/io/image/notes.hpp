#pragma once
/// What a picture's file says of itself.

#include <microtrace/film.hpp>

#include <string>
#include <vector>

namespace microtrace::io {

struct Note {
  std::string name, text;
};

/// What was done to the light, if the display asks for anything: of formats that hold the light
/// itself that nothing was.
[[nodiscard]] std::vector<Note> notes_of(const Display& display, bool holds_light);

}  // namespace microtrace::io
