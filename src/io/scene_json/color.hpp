#pragma once
/// Colors and other bounded numbers of a JSON scene.

#include "io/json/reader.hpp"

#include <microtrace/math.hpp>

#include <functional>
#include <map>
#include <string>

namespace microtrace::io {

/// The scene's named colors.
using Colors = std::map<std::string, Vec3, std::less<>>;

/// Maximum of each channel of emitted light, so that sums and products stay finite.
inline constexpr double kMaxRadiance = 1e9;

/// Reads the root's member "colors". Throws Error, as do the functions below.
[[nodiscard]] Colors read_colors(const JsonReader& json);

/// Three numbers from 0 to `most`, or a name.
[[nodiscard]] Vec3 read_color(const JsonReader& json, const Colors& colors, double most = 1);

/// A number of at least `least` that is finite in float32.
[[nodiscard]] float read_at_least(const JsonReader& json, double least);

/// A number from 0 to 1.
[[nodiscard]] float read_share(const JsonReader& json);

/// A positive number, also when rounded to float32.
[[nodiscard]] float read_positive(const JsonReader& json);

/// true or false.
[[nodiscard]] bool read_boolean(const JsonReader& json);

}  // namespace microtrace::io
