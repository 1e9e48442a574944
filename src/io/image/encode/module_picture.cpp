#include "io/image/encode/module_picture.hpp"

#include "io/image/encode/eight_bits.hpp"

#include <array>
#include <cstddef>
#include <type_traits>

namespace microtrace::io {
namespace {

constexpr std::array kColorNames = {"R", "G", "B", "A"};

}  // namespace

ModulePicture::ModulePicture(const Film& film, const MicrotraceFormat& format)
    : notes_(notes_of(film, format.is_float != 0)) {
  if (format.is_float != 0) {
    add_float_colors(film);
  } else {
    add_byte_colors(film);
  }
  add_channels(film);
  for (const Note& note : notes_) {
    note_views_.push_back({.name = note.name.c_str(), .text = note.text.c_str()});
  }
  picture_ = {.width = film.size().width,
              .height = film.size().height,
              .x0 = film.x0,
              .y0 = film.y0,
              .whole_width = film.whole.width,
              .whole_height = film.whole.height,
              .is_color = film.display.srgb ? 1 : 0,
              .channels = channels_.data(),
              .channel_count = channels_.size(),
              .notes = note_views_.data(),
              .note_count = note_views_.size()};
}

void ModulePicture::add_float_colors(const Film& film) {
  const Vec3& first = film.row(0)[0];
  for (glm::length_t i = 0; i < 3; ++i) {
    channels_.push_back({.name = kColorNames[static_cast<std::size_t>(i)],
                         .first = &first[i],
                         .stride = sizeof(Vec3),
                         .number = kMicrotraceF32});
  }
  if (!film.has_alpha()) return;
  channels_.push_back({.name = kColorNames[3],
                       .first = film.alpha_row(0).data(),
                       .stride = sizeof(float),
                       .number = kMicrotraceF32});
}

void ModulePicture::add_byte_colors(const Film& film) {
  const std::size_t count = film.has_alpha() ? 4 : 3;
  const std::size_t row = count * film.size().width;
  bytes_.resize(row * film.size().height);
  for (std::uint32_t y = 0; y < film.size().height; ++y) {
    encode_row(film, y, bytes_.data() + y * row);
  }
  for (std::size_t i = 0; i < count; ++i) {
    channels_.push_back({.name = kColorNames[i],
                         .first = bytes_.data() + i,
                         .stride = count,
                         .number = kMicrotraceU8});
  }
}

void ModulePicture::add_channels(const Film& film) {
  for (const Channel& channel : film.channels) {
    std::visit(
        [&](const auto& values) {
          using Number = typename std::remove_cvref_t<decltype(values)>::value_type;
          channels_.push_back(
              {.name = channel.name.c_str(),
               .first = values.data(),
               .stride = sizeof(Number),
               .number = std::is_same_v<Number, float> ? kMicrotraceF32 : kMicrotraceU32});
        },
        channel.values);
  }
}

}  // namespace microtrace::io
