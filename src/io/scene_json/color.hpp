#pragma once
/// Reads colors and other bounded numbers of a JSON scene.

#include "io/json/reader.hpp"

#include <microtrace/math.hpp>

#include <functional>
#include <map>
#include <string>

namespace microtrace::io {

/// The scene's named colors.
using Colors = std::map<std::string, Vec3, std::less<>>;

/// The maximum of each channel of emitted light. It keeps sums and products finite.
inline constexpr double kMaxRadiance = 1e9;

/// Reads the root's member "colors". Throws Error, as do the functions below.
[[nodiscard]] Colors read_colors(const JsonReader& json);

/// Reads a color: three numbers from 0 to `most`, or a name.
[[nodiscard]] Vec3 read_color(const JsonReader& json, const Colors& colors, double most = 1);

/// Reads a number that is at least `least` and finite in float32.
[[nodiscard]] float read_at_least(const JsonReader& json, double least);

/// Reads a number from `least` to `most`.
[[nodiscard]] float read_in_range(const JsonReader& json, double least, double most);

/// Reads a number from 0 to 1.
[[nodiscard]] float read_share(const JsonReader& json);

/// Reads a number that is positive even when rounded to float32.
[[nodiscard]] float read_positive(const JsonReader& json);

/// Reads true or false.
[[nodiscard]] bool read_boolean(const JsonReader& json);

}  // namespace microtrace::io
