#include "io/image/encode/notes.hpp"

#include "scene/validate/validate.hpp"

namespace microtrace::io {

std::vector<Note> notes_of(const Display& display, bool holds_light) {
  if (!display.srgb || (display.exposure == 0 && display.tone_map == ToneMap::none)) return {};
  const ToneMap tone_map = holds_light ? ToneMap::none : display.tone_map;
  return {{.name = "microtrace:exposure", .text = decimal(holds_light ? 0.0 : display.exposure)},
          {.name = "microtrace:tonemap", .text = std::string(name_of(tone_map))}};
}

}  // namespace microtrace::io
