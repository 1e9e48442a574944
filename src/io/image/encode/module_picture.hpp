#pragma once
/// Converts a film to a module's picture.

#include "io/image/encode/notes.hpp"
#include "io/image/module_abi.hpp"

#include <microtrace/film.hpp>

#include <cstdint>
#include <vector>

namespace microtrace::io {

class ModulePicture {
 public:
  /// The film must outlive this object.
  ModulePicture(const Film& film, const MicrotraceFormat& format);

  [[nodiscard]] const MicrotracePicture& get() const { return picture_; }

 private:
  void add_float_colors(const Film& film);
  void add_byte_colors(const Film& film);
  void add_channels(const Film& film);

  std::vector<std::uint8_t> bytes_;  // converted pixels, if the format needs conversion
  std::vector<MicrotraceChannel> channels_;
  std::vector<Note> notes_;
  std::vector<MicrotraceNote> note_views_;
  MicrotracePicture picture_;
};

}  // namespace microtrace::io
