#include "io/image/encode/notes.hpp"

#include "scene/validate/validate.hpp"

namespace microtrace::io {

std::vector<Note> notes_of(const Film& film, bool holds_light) {
  std::vector<Note> notes;
  if (!film.denoiser.empty())
    notes.push_back({.name = "microtrace:denoiser", .text = film.denoiser});
  const Display& display = film.display;
  if (!display.srgb || (display.exposure == 0 && display.tone_map == ToneMap::none)) return notes;
  const ToneMap tone_map = holds_light ? ToneMap::none : display.tone_map;
  notes.push_back(
      {.name = "microtrace:exposure", .text = decimal(holds_light ? 0.0 : display.exposure)});
  notes.push_back({.name = "microtrace:tonemap", .text = std::string(name_of(tone_map))});
  return notes;
}

}  // namespace microtrace::io
