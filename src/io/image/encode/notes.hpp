#pragma once
/// Text entries that describe a picture in its file.

#include <microtrace/film.hpp>

#include <string>
#include <vector>

namespace microtrace::io {

struct Note {
  std::string name, text;
};

/// Returns notes about the denoiser and the requested display transforms, if any. If the format
/// stores linear light, the notes state that no transform was applied.
[[nodiscard]] std::vector<Note> notes_of(const Film& film, bool holds_light);

}  // namespace microtrace::io
